#include <limits>

#include "netem/model/impairment.h"
#include "netem/syntax/data_files.h"
#include "netem/syntax/impairment_words.h"

namespace palp::netem {
namespace {

constexpr std::string_view kTcClauses =
    "delay, loss, ecn, duplicate, corrupt, reorder, gap, rate, slot, limit or distribution";
constexpr std::string_view kOwnClauses =
    ", or correlation-time, floor, histogram, trace, replay, stall, blackout, queue, mtu, "
    "truncate, "
    "dscp-clear or order";

/// tc takes the beginning of a clause's name for it, in this order.
bool begins(std::string_view word, std::string_view name) {
  return !word.empty() && name.substr(0, word.size()) == word;
}

void read_delay(const Word& word, WordReader& words, DelayLaw& law) {
  words.once(word, "delay");
  law.mean = words.time("the mean delay");
  if (!words.next_is_number()) return;
  law.jitter = words.time("the jitter");
  words.once(word, "jitter");
  if (!words.next_is_number()) return;
  law.correlation = words.share("the correlation of successive delays");
  words.once(word, "correlation");
}

FourStateLaw read_four_states(WordReader& words) {
  FourStateLaw law;
  law.p13 = words.share("p13, from good to a burst,");
  law.p31 = 1 - law.p13;
  if (words.next_is_number()) law.p31 = words.share("p31, from a burst to good,");
  if (words.next_is_number()) law.p32 = words.share("p32, from lost to good inside a burst,");
  if (words.next_is_number()) law.p23 = words.share("p23, from good to lost inside a burst,");
  if (words.next_is_number()) law.p14 = words.share("p14, the single loss,");
  return law;
}

GemodelLaw read_gemodel(WordReader& words) {
  GemodelLaw law;
  law.to_bad = words.share("p, from good to bad,");
  law.to_good = 1 - law.to_bad;
  if (words.next_is_number()) law.to_good = words.share("r, from bad to good,");
  if (words.next_is_number()) law.loss_bad = words.share("1-h, the loss in the bad state,");
  if (words.next_is_number()) law.loss_good = words.share("1-k, the loss in the good state,");
  return law;
}

/// Sums that a chain of probabilities cannot have; Linux lets them overflow.
void check_four_states(const Word& word, WordReader& words, const FourStateLaw& law, Mode mode) {
  if (mode == Mode::Netem61) return;
  if (law.p13 + law.p14 > 1) words.refuse(word, "p13 + p14 of at most 100%");
  if (law.p31 + law.p32 > 1) words.refuse(word, "p31 + p32 of at most 100%");
}

void read_loss(WordReader& words, Impairment& into, const FileReader& read) {
  const Word kind = words.peek();
  const bool exact = into.mode == Mode::Exact;
  if (exact && words.take_if("burst")) {
    words.once(kind, "loss burst");
    into.burst.rate = words.frequency("how often a burst begins");
    into.burst.length = words.positive_time("the length of a burst");
  } else if (exact && words.take_if("gilbert-time")) {
    words.once(kind, "loss gilbert-time");
    const auto stay = [&](std::string_view what) {
      const Word word = words.peek();
      const Duration span = words.time(what);
      if (span < kStayMin) words.refuse(word, std::string{what} + " of at least 0.1ms");
      return span;
    };
    into.gilbert.good = stay("the mean stay in the good state");
    into.gilbert.bad = stay("the mean stay in the bad state");
    if (words.next_is_number()) into.gilbert.loss_bad = words.share("the loss in the bad state");
    if (words.next_is_number()) into.gilbert.loss_good = words.share("the loss in the good state");
  } else if (exact && words.take_if("bitmap")) {
    words.once(kind, "bitmap");
    const Word name = words.take();
    if (const auto text = read_named(name, words, "the name of a file of 0 and 1", read)) {
      if (auto bitmap = parse_loss_bitmap(name.text, *text)) {
        into.bitmap = *std::move(bitmap);
      } else {
        words.refuse(name, bitmap.error());
      }
    }
  } else if (words.take_if("state")) {
    words.once(kind, "loss model");
    into.state = read_four_states(words);
    check_four_states(kind, words, *into.state, into.mode);
  } else if (words.take_if("gemodel")) {
    words.once(kind, "loss model");
    into.gemodel = read_gemodel(words);
  } else {
    const bool random = words.take_if("random");
    if (!random && !words.next_is_number()) {
      return words.refuse(kind,
                          exact ? "a share as 5%, or random, state, gemodel, burst, gilbert-time "
                                  "or bitmap"
                                : "a share as 5%, or random, state or gemodel");
    }
    words.once(kind, into.mode == Mode::Netem61 ? "loss model" : "loss");
    into.loss = words.chance("the probability of loss");
  }
}

void read_rate(WordReader& words, RateLaw& law) {
  constexpr std::int64_t kOverheadMax = 1'000'000;
  law.bytes_per_s = words.rate("the rate");
  if (!words.next_is_number()) return;
  law.overhead =
      static_cast<std::int32_t>(words.count("the overhead in bytes", -kOverheadMax, kOverheadMax));
  if (!words.next_is_number()) return;
  law.cell = static_cast<std::uint32_t>(words.count("the cell size in bytes", 0, kOverheadMax));
  if (!words.next_is_number()) return;
  law.cell_overhead = static_cast<std::int32_t>(
      words.count("the overhead of a cell in bytes", -kOverheadMax, kOverheadMax));
}

void read_slot(WordReader& words, Impairment& into, const FileReader& read) {
  SlotLaw& law = into.slot;
  const Word first = words.peek();
  if (words.take_if("distribution")) {
    law.spacing.emplace();
    read_shape(words, into.mode, *law.spacing, read);
    law.spacing->mean = words.positive_time("the mean time between slots");
    law.spacing->jitter = words.positive_time("the jitter of that time");
    law.min = law.max = law.spacing->mean;
  } else {
    law.min = words.time("the least time between slots");
    law.max = words.next_is_number() ? words.time("the most time between slots") : law.min;
    if (law.max < law.min) words.refuse(first, "the most time not below the least");
    if (into.mode == Mode::Exact && law.min <= Duration{}) words.refuse(first, "a time above 0");
  }
  constexpr std::uint64_t kMost = 2'147'483'647;
  if (words.take_if("packets")) law.packets = words.size("the packets of a slot", kMost);
  if (words.take_if("bytes")) law.bytes = words.size("the bytes of a slot", kMost);
}

/// What tc refuses only when it has read everything.
void check_together(WordReader& words, Impairment& impairment) {
  if (words.error()) return;
  const Word end{{}, words.peek().column};
  const DelayLaw& delay = impairment.delay;
  if (words.said("distribution") && !words.said("jitter")) {
    words.refuse(end, "a delay with a jitter for the distribution, as in 'delay 50ms 10ms'");
  }
  const bool positive = delay.shape == DelayShape::Gamma || delay.shape == DelayShape::LogNormal;
  if (positive && delay.jitter > Duration{} && delay.mean == Duration{}) {
    words.refuse(end, "a delay above 0: a gamma or lognormal law of mean 0 has no spread");
  }
  ReorderLaw& reorder = impairment.reorder;
  if (words.said("gap") && !words.said("reorder")) reorder.chance.share = 1;
  if (reorder.chance.share > 0 && reorder.gap == 0) reorder.gap = 1;
  const bool delayed = delay.mean > Duration{} || delay.shape == DelayShape::Histogram ||
                       !impairment.trace.points.empty();
  if (reorder.gap > 0 && reorder.chance.share > 0 && !delayed) {
    words.refuse(end, "a delay: without one there is nothing to overtake");
  }
  const bool lossy = words.said("loss model") || words.said("loss") || words.said("loss burst") ||
                     words.said("loss gilbert-time") || words.said("bitmap");
  if (impairment.ecn && !lossy) words.refuse(end, "a loss model for 'ecn'");
  if (impairment.queue != QueueLaw{} && impairment.rate.bytes_per_s == 0) {
    words.refuse(end, "a rate for the queue to wait for");
  }
}

Mode read_mode(WordReader& words, Mode mode) {
  if (!words.take_if("mode")) return mode;
  const Word name = words.take();
  if (name.text == "exact") return Mode::Exact;
  if (name.text != "netem-6.1") words.refuse(name, "exact or netem-6.1");
  return Mode::Netem61;
}

}  // namespace

std::optional<std::string> read_named(const Word& name,
                                      WordReader& words,
                                      const std::string& expected,
                                      const FileReader& read) {
  if (words.error()) return std::nullopt;
  if (name.text.empty()) {
    words.refuse(name, expected);
    return std::nullopt;
  }
  auto text = read(std::string{name.text});
  if (text) return *std::move(text);
  words.refuse(name, text.error());
  return std::nullopt;
}

void read_shape(WordReader& words, Mode mode, DelayLaw& law, const FileReader& read) {
  const Word word = words.take();
  const std::string name{word.text};
  if (name == "normal") {
    law.shape = DelayShape::Normal;
  } else if (name == "pareto") {
    law.shape = DelayShape::Pareto;
  } else if (name == "paretonormal") {
    law.shape = DelayShape::ParetoNormal;
  } else if (name == "uniform" && mode == Mode::Exact) {
    law.shape = DelayShape::Uniform;
  } else if (name == "gamma" && mode == Mode::Exact) {
    law.shape = DelayShape::Gamma;
  } else if (name == "lognormal" && mode == Mode::Exact) {
    law.shape = DelayShape::LogNormal;
  } else {
    const std::string known = mode == Mode::Exact
                                  ? "uniform, normal, pareto, paretonormal, gamma, lognormal"
                                  : "normal, pareto, paretonormal";
    const auto text = name.empty() ? Result<std::string>{fail("no name")}
                                   : read(name.ends_with(".dist") ? name : name + ".dist");
    if (!text)
      return words.refuse(word, known + " or the name of a table (" + text.error().text + ")");
    auto table = parse_delay_table(name, *text);
    if (!table) return words.refuse(word, Error{table.error().text});
    law.shape = DelayShape::Table;
    law.table = *std::move(table);
  }
}

bool read_tc_clause(const Word& word, WordReader& words, Impairment& into, const FileReader& read) {
  constexpr std::uint64_t kLimitMax = 4'294'967'295;
  if (begins(word.text, "limit")) {
    words.once(word, "limit");
    into.limit = words.size("how many datagrams may be on their way", kLimitMax);
  } else if (begins(word.text, "delay") || begins(word.text, "latency")) {
    read_delay(word, words, into.delay);
  } else if (begins(word.text, "loss") || begins(word.text, "drop")) {
    read_loss(words, into, read);
  } else if (begins(word.text, "ecn")) {
    words.once(word, "ecn");
    into.ecn = true;
  } else if (begins(word.text, "reorder")) {
    words.once(word, "reorder");
    into.reorder.chance = words.chance("the probability of being sent at once");
  } else if (begins(word.text, "corrupt")) {
    words.once(word, "corrupt");
    into.corrupt = words.chance("the probability of a flipped bit");
    if (into.mode == Mode::Exact) into.corrupt_payload = words.take_if("payload");
  } else if (begins(word.text, "gap")) {
    words.once(word, "gap");
    into.reorder.gap = static_cast<std::uint32_t>(
        words.count("the gap", 0, std::numeric_limits<std::uint32_t>::max()));
  } else if (begins(word.text, "duplicate")) {
    words.once(word, "duplicate");
    into.duplicate = words.chance("the probability of a copy");
  } else if (begins(word.text, "distribution")) {
    words.once(word, "distribution");
    read_shape(words, into.mode, into.delay, read);
  } else if (begins(word.text, "rate")) {
    words.once(word, "rate");
    read_rate(words, into.rate);
  } else if (begins(word.text, "slot")) {
    words.once(word, "slot");
    read_slot(words, into, read);
  } else {
    return false;
  }
  return true;
}

Result<Impairment> parse_impairment(std::string_view text, Mode mode) {
  return parse_impairment(text, mode, read_data_file);
}

Result<Impairment> parse_impairment(std::string_view text, Mode mode, const FileReader& read) {
  WordReader words{text};
  Impairment impairment;
  impairment.mode = read_mode(words, mode);
  if (impairment.mode == Mode::Netem61) impairment.order = Order::Netem;
  if (words.take_if("none") && !words.at_end()) words.refuse(words.peek(), "nothing after 'none'");
  while (!words.error() && !words.at_end()) {
    const Word word = words.take();
    const bool known =
        (impairment.mode == Mode::Exact && read_own_clause(word, words, impairment, read)) ||
        read_tc_clause(word, words, impairment, read);
    if (!known) {
      const bool exact = impairment.mode == Mode::Exact;
      words.refuse(word, std::string{kTcClauses} + std::string{exact ? kOwnClauses : ""});
    }
  }
  check_together(words, impairment);
  if (words.error()) return tl::unexpected<Error>(*words.error());
  return impairment;
}

}  // namespace palp::netem
