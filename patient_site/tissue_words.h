#pragma once

#include <string_view>

#include "patient_site/block_tissue.h"
#include "patient_site/relaxation.h"

namespace palp::patient {

/// What the words of a phantom describe.
struct DescribedTissue {
  BlockTissue block;
  Relaxation relaxation{};
};

/// Parts, each a name and its NAME=VALUE words, separated by ";" or ends of lines; "#" begins a
/// comment. Lengths in mm, angles in degrees; what is not said is as in the first column's default.
///
///   ball depth=12 radius=15 ratio=856 at=20,0      (also cylinder; as many as lie apart)
///   block e_kpa=15.3 height=57 law=exponential varies=0.05 length=10 seed=1
///   surface slope_x=5 slope_y=0 radius=60 at=0,0   (radius below 0: a hollow)
///   relaxes share=0.1 time_s=1
///   database file=PATH                             (of palp-fem database)
///
/// The tissue has passed check(). The sentence of an error names the part.
[[nodiscard]] Result<DescribedTissue> parse_tissue_words(std::string_view text);

/// Whether `text` begins as such words do.
[[nodiscard]] bool are_tissue_words(std::string_view text);

}  // namespace palp::patient
