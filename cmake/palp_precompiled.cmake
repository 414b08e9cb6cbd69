# Headers that most sources read are compiled once per kind of target and shared by all targets of
# that kind. Sources list what they use all the same: preset fuzz builds without
# (CMAKE_DISABLE_PRECOMPILE_HEADERS), and clang-tidy in ./test reads without.
set(PALP_STANDARD_HEADERS
    <algorithm>
    <array>
    <atomic>
    <charconv>
    <chrono>
    <cmath>
    <cstddef>
    <cstdint>
    <cstdio>
    <cstdlib>
    <cstring>
    <deque>
    <fstream>
    <functional>
    <limits>
    <map>
    <memory>
    <numbers>
    <numeric>
    <optional>
    <set>
    <span>
    <sstream>
    <string>
    <string_view>
    <tuple>
    <utility>
    <variant>
    <vector>
    <tl/expected.hpp>)

# palp_precompiled(test HEADERS <gtest/gtest.h> DEPENDS GTest::gtest OPTIONS -O3): a kind. Flags
# must be those of its targets; GCC's -Winvalid-pch tells where they are not.
function(palp_precompiled kind)
  cmake_parse_arguments(ARG "" "" "HEADERS;DEPENDS;OPTIONS" ${ARGN})
  set(name palp_precompiled_${kind})
  file(CONFIGURE OUTPUT ${name}.cc CONTENT "")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)
  target_link_libraries(${name} PRIVATE palp_options palp_warnings tl::expected ${ARG_DEPENDS})

  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${PALP_STANDARD_HEADERS} ${ARG_HEADERS})
endfunction()

function(palp_use_precompiled target kind)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  target_precompile_headers(${target} REUSE_FROM palp_precompiled_${kind})
endfunction()
