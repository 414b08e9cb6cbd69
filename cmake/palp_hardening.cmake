# What makes an error in memory harder to use; in every program and library of a release build.
# tests/system/hardened looks for it in the programs.
option(PALP_HARDEN "Stack, heap and link-time guards (our preset release switches this on)" OFF)

# Programs refuse system calls that they never ask for. A sanitizer asks for them at a program's end.
option(PALP_FILTER_CALLS "Programs filter their system calls; never under PALP_SANITIZE" ON)
if(PALP_SANITIZE)
  set(PALP_FILTER_CALLS OFF)
endif()

function(palp_harden target)
  if(NOT PALP_HARDEN OR PALP_SANITIZE)
    return()
  endif()
  target_compile_options(
    ${target}
    INTERFACE -U_FORTIFY_SOURCE
              -D_FORTIFY_SOURCE=$<IF:$<CXX_COMPILER_ID:GNU>,3,2>
              -fstack-protector-strong
              -fstack-clash-protection
              -fcf-protection
              -fPIE)
  target_link_options(${target} INTERFACE -pie -Wl,-z,relro,-z,now -Wl,-z,noexecstack)
endfunction()
