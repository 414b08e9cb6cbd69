# palp_embed_texts(scenario_texts.cc FILES scenarios/standard.textproto ...): files become string
# literals, so that a program runs from anywhere. In scenario_texts.cc.in @PALP_TEXTS@ stands for
# one {"standard", R"text(...)text"} per file.
function(palp_embed_texts source)
  cmake_parse_arguments(ARG "" "" "FILES" ${ARGN})
  list(TRANSFORM ARG_FILES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARG_FILES})
  set(PALP_TEXTS "")
  foreach(file IN LISTS ARG_FILES)
    cmake_path(GET file STEM name)
    file(READ ${file} text)
    string(APPEND PALP_TEXTS "    {\"${name}\", R\"text(${text})text\"},\n")
  endforeach()
  configure_file(${source}.in ${source} @ONLY)
endfunction()
