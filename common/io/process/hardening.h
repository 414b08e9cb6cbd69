#pragma once

#include <optional>
#include <string>

/// What a program gives up before it reads keys. Thread: main, before any other begins.
namespace palp::io {

/// No core file, no debugger of other users, no reading of this process's memory by them: session
/// keys and private keys lie there. Programs that are started from here on gain no rights by their
/// file (no_new_privs), and none are: see system_call_filter.h. @returns what the system refused,
/// one sentence; nothing: all is done.
[[nodiscard]] std::optional<std::string> harden_process();

}  // namespace palp::io
