# What `cmake --install build/release --prefix P` puts where. Programs find their traces in
# ../share/palp beside themselves and carry everything else inside, so a prefix may be moved.
include(GNUInstallDirs)
set(PALP_PROGRAMS
    palp-surgeon
    palp-patient
    palp-lab
    palp-review
    palp-netem
    palp-fem
    palp-relay
    palp-study)
install(TARGETS ${PALP_PROGRAMS} RUNTIME)

set(data ${CMAKE_INSTALL_DATADIR}/palp)
install(DIRECTORY netem/traces netem/profiles patient_site/phantoms lab/scenarios DESTINATION ${data})
install(FILES fem/depth_database.bin DESTINATION ${data})
install(DIRECTORY proto/ DESTINATION ${data}/schemas FILES_MATCHING PATTERN "*.proto" PATTERN "*.md")

install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES README.md ARCHITECTURE.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

foreach(program IN LISTS PALP_PROGRAMS)
  install(
    FILES packaging/palp.bash
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME ${program})
endforeach()

# A page is what --help says, so the programs write them; not under a sanitizer, which may print.
if(NOT PALP_SANITIZE)
  set(man ${PROJECT_BINARY_DIR}/man)
  list(TRANSFORM PALP_PROGRAMS REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE files)
  add_custom_command(
    OUTPUT ${man}/made
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${man}
    COMMAND ${PROJECT_SOURCE_DIR}/packaging/man-pages ${man} ${files}
    COMMAND ${CMAKE_COMMAND} -E touch ${man}/made
    DEPENDS ${PALP_PROGRAMS} packaging/man-pages
    COMMENT "Writing man pages"
    VERBATIM)
  add_custom_target(palp_man ALL DEPENDS ${man}/made)
  install(
    DIRECTORY ${man}/
    DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
    FILES_MATCHING
    PATTERN "*.1")
endif()

# Who may open haptic masters and force cards: udev reads it where the prefix is /usr.
install(FILES packaging/70-palp-hid.rules DESTINATION lib/udev/rules.d)
