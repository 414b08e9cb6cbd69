#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/result.h"
#include "common/record/byte_sink.h"
#include "common/record/file_bytes.h"
#include "review/time_line.h"

namespace palp::review {

/// The two files of a session.
struct PairBytes {
  record::FileBytes surgeon;
  record::FileBytes patient;
};

/// Writes both files of a session as one: all topics of both sites, stamped by the surgeon's wall
/// clock, roughly in order of time. Metadata and attachments keep their names behind `surgeon/` and
/// `patient/`; `palp.merge` says how the clocks lie and how certain that is. Instants inside of
/// messages stay their site's own. @returns how many messages were written.
[[nodiscard]] Result<std::uint64_t> merge_files(const PairBytes& files,
                                                const SessionPair& session,
                                                record::ByteSink& out);

}  // namespace palp::review
