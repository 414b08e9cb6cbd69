#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/core/result.h"
#include "netem/model/impairment.h"

/// Impairments as words, both ways.
namespace palp::netem {

/// Finds the content of a data file by the name that the words say.
using FileReader = std::function<Result<std::string>(const std::string& name)>;

/// The words of an impairment, in any order (`none`, or an empty text: a perfect link). tc's own
/// argument strings are understood as tc understands them: a bare time is in microseconds, a bare
/// share in per cent, a bare rate in bit/s: see impairment_help().
/// `mode` holds where the words do not say `mode exact` or `mode netem-6.1` first.
/// @returns or one sentence with the column (from 1), the word and what was expected.
[[nodiscard]] Result<Impairment> parse_impairment(std::string_view text, Mode mode = Mode::Exact);
[[nodiscard]] Result<Impairment> parse_impairment(std::string_view text,
                                                  Mode mode,
                                                  const FileReader& read);

/// A page that explains the words.
[[nodiscard]] std::string_view impairment_help() noexcept;

/// The words that parse back to exactly the same impairment.
[[nodiscard]] std::string to_string(const Impairment& impairment);

/// The plain link law of the laboratory, for `--delay-ms --jitter-ms --loss`:
/// max(0.2 delay, delay + jitter * N(0, 1)), order by release, `loss` [1] independent.
[[nodiscard]] Result<Impairment> impairment_from_delay(Duration delay,
                                                       Duration jitter,
                                                       double loss);

/// The same with half of a round trip as delay, for `--rtt-ms`; `jitter` stays that of one way.
[[nodiscard]] Result<Impairment> impairment_from_rtt(Duration rtt, Duration jitter, double loss);

}  // namespace palp::netem
