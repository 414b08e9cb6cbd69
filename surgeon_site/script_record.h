#pragma once

#include "common/record/session_writer.h"
#include "surgeon_site/gesture_script.h"

namespace palp::surgeon {

/// Name of the attachment with the script's text, in a surgeon's session file.
inline constexpr const char* kScriptAttachment = "script.txt";

/// What the hand was told, into a session file: whoever reviews it has another file of that name,
/// or none.
inline void describe_script(const GestureScript& script, record::SessionInfo& info) {
  if (script.text().empty()) return;
  info.attachments.push_back({kScriptAttachment, "text/plain", script.text()});
}

}  // namespace palp::surgeon
