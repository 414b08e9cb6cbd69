#pragma once

#include <optional>
#include <string>

/// What a process may not ask the kernel for any more. Thread: main, before any other begins.
namespace palp::io {

/// Refuses (EPERM) what a site never asks for and who took it over would: other programs and
/// processes, looking into processes, mounting, modules, other rights, sockets of other families.
/// For this thread and all that it begins; nothing takes it back. @returns what the system refused,
/// one sentence; nothing: all is done.
[[nodiscard]] std::optional<std::string> refuse_system_calls();

}  // namespace palp::io
