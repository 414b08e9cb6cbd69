#pragma once

#include <span>

#include "common/message/depth.h"

namespace palp::estimator {

/// What several strokes at one place say together: the verdict of most strokes that make a
/// statement (Found wins a tie), the median depth of those that found something, the median hash of
/// all that have one. Strokes with error bars were added up by their estimator already: the last
/// that makes a statement has heard them all, and its interval is the answer. Without any
/// statement: Invalid, with the last stroke's reason. Pure.
[[nodiscard]] DepthEstimate summarise_depths(std::span<const DepthEstimate> strokes);

}  // namespace palp::estimator
