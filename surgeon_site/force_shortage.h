#pragma once

#include "common/core/lapse.h"
#include "common/core/site_state.h"
#include "common/record/notes.h"
#include "surgeon_site/tip_comparison.h"

namespace palp::surgeon {

/// Says whether the hand feels less than the tissue, by how much and why: what the law knows that
/// it lacks, what the tip measures more, and that the tip is not where the hand is. Said is what
/// lasts; in Hold, where no news comes, what was said stays. Thread: rt. A value.
class ForceShortage {
 public:
  struct Look {
    SiteState state{};
    double missing{};         ///< [N], of the tissue that the law believes in
    double too_stiff{};       ///< [N], of the told tissue, what is not shown of it
    double apart{};           ///< [m], along the surface, of hand and stage
    TipComparison::Look tip;  ///< given to the hand, and measured
  };

  void look(const Look& now, const PatientDevices& devices, const Lapse& lapse) noexcept;

  /// None: the force is whole. Else ForceIncomplete, TissueTooStiff, TipFeelsMore or TipElsewhere.
  [[nodiscard]] record::NoteCode why() const noexcept { return why_; }
  /// [N], so much less; 0: nobody can say.
  [[nodiscard]] double by() const noexcept { return by_; }

 private:
  /// Something that must last before it is said, and be over for a while before it is not.
  class Lasting {
   public:
    void look(bool is, double on, double off, double passed) noexcept;
    [[nodiscard]] bool said() const noexcept { return said_; }

   private:
    double otherwise_{};  ///< [s], than it is said
    bool said_{};
  };

  [[nodiscard]] record::NoteCode reason(const Look& now) const noexcept;

  Lasting law_;
  Lasting elsewhere_;
  TipComparison comparison_;
  record::NoteCode why_{};
  double by_{};  ///< [N]
};

}  // namespace palp::surgeon
