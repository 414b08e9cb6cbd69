#include "netem/syntax/impairment_words.h"

namespace palp::netem {
namespace {

/// An option of the delay law that means nothing without jitter.
void needs_jitter(const Word& word, WordReader& words) {
  if (!words.said("jitter") && !words.said("histogram")) {
    words.refuse(word, "a jitter before it, as in 'delay 50ms 10ms'");
  }
}

void read_correlation_time(const Word& word, WordReader& words, DelayLaw& law) {
  needs_jitter(word, words);
  if (words.said("correlation"))
    words.refuse(word, "one correlation only: per datagram or in time");
  words.once(word, "correlation-time");
  law.correlation_time = words.positive_time("the correlation time");
}

void read_blackout(const Word& word, WordReader& words, Impairment& into) {
  if (into.blackouts.size() == kBlackoutsMax) {
    words.refuse(word, "at most " + std::to_string(kBlackoutsMax) + " blackouts");
  }
  Blackout window;
  window.from = words.time("the begin of the blackout");
  window.length = words.positive_time("the length of the blackout");
  into.blackouts.push_back(window);
}

void read_order(const Word& word, WordReader& words, Impairment& into) {
  words.once(word, "order");
  const Word policy = words.take();
  if (policy.text == "netem" || policy.text == "free") {
    into.order = Order::Netem;
  } else if (policy.text == "swap") {
    into.order = Order::Swap;
    into.swap = words.chance("the probability of overtaking");
    const Word depth = words.take();
    if (depth.text != "depth") words.refuse(depth, "depth");
    into.swap_depth = static_cast<std::uint32_t>(
        words.count("how many are overtaken", 1, std::int64_t{kSwapDepthMax}));
  } else if (policy.text == "keep") {
    into.order = Order::Keep;
  } else {
    words.refuse(policy, "keep, netem or swap");
  }
}

void read_stall(const Word& word, WordReader& words, StallLaw& law) {
  constexpr double kSpreadMax = 3;
  words.once(word, "stall");
  law.rate = words.frequency("how often a stall begins");
  law.median = words.positive_time("the median length of a stall");
  if (words.next_is_number()) {
    law.spread = words.number("the spread of the logarithm of its length", 0, kSpreadMax);
  }
}

void read_queue(const Word& word, WordReader& words, QueueLaw& law) {
  constexpr std::uint64_t kMost = 1'000'000'000'000;
  words.once(word, "queue");
  const QueueLaw before = law;
  for (;;) {
    if (words.take_if("packets")) {
      law.packets = words.size("how many datagrams may wait", kMost);
    } else if (words.take_if("bytes")) {
      law.bytes = words.size("how many bytes may wait", kMost);
    } else if (words.take_if("time")) {
      law.wait = words.positive_time("how long a datagram may wait");
    } else if (words.take_if("codel")) {
      law.codel = true;
      if (words.take_if("target")) law.target = words.positive_time("CoDel's target");
      if (words.take_if("interval")) law.interval = words.positive_time("CoDel's interval");
    } else {
      break;
    }
  }
  if (law == before) words.refuse(words.peek(), "packets N, bytes N, time T or codel");
}

void read_truncate(const Word& word, WordReader& words, Impairment& into) {
  words.once(word, "truncate");
  into.truncate = words.chance("the probability of being cut off");
  const Word to = words.take();
  if (to.text != "to") words.refuse(to, "to, and how many bytes are left");
  into.truncate_to =
      static_cast<std::uint64_t>(words.count("the bytes of payload left", 0, 65'535));
}

void read_trace(const Word& word, WordReader& words, Impairment& into, const FileReader& read) {
  words.once(word, "trace");
  const Word name = words.take();
  const auto text = read_named(name, words, "the name of a trace", read);
  if (!text) return;
  auto trace = parse_delay_trace(name.text, *text);
  if (!trace) return words.refuse(name, trace.error());
  into.trace = *std::move(trace);
  into.trace.loop = words.take_if("loop");
  into.trace.dither = words.take_if("dither");
}

void read_replay(const Word& word, WordReader& words, Impairment& into, const FileReader& read) {
  words.once(word, "replay");
  const Word name = words.take();
  const auto text = read_named(name, words, "the name of a recording", read);
  if (!text) return;
  auto recording = parse_recording(name.text, *text);
  if (!recording) return words.refuse(name, recording.error());
  into.replay = *std::move(recording);
  // A recording is the whole truth; whatever it does not hold leaves as it says.
  into.order = Order::Netem;
}

void read_histogram(const Word& word, WordReader& words, Impairment& into, const FileReader& read) {
  words.once(word, "histogram");
  const Word name = words.take();
  const auto text = read_named(name, words, "the name of a histogram of delays", read);
  if (!text) return;
  auto histogram = parse_delay_histogram(name.text, *text);
  if (!histogram) return words.refuse(name, histogram.error());
  if (words.said("delay")) words.refuse(word, "one law of delay only");
  words.once(word, "delay");
  into.delay.shape = DelayShape::Histogram;
  into.delay.histogram = *std::move(histogram);
}

}  // namespace

bool read_own_clause(const Word& word,
                     WordReader& words,
                     Impairment& into,
                     const FileReader& read) {
  constexpr std::int64_t kMtuMin = 68;  // RFC 791
  if (word.text == "floor") {
    words.once(word, "floor");
    into.delay.floor = words.share("the least delay as a share of the mean");
  } else if (word.text == "correlation-time") {
    read_correlation_time(word, words, into.delay);
  } else if (word.text == "histogram") {
    read_histogram(word, words, into, read);
  } else if (word.text == "trace") {
    read_trace(word, words, into, read);
  } else if (word.text == "replay") {
    read_replay(word, words, into, read);
  } else if (word.text == "blackout") {
    read_blackout(word, words, into);
  } else if (word.text == "stall") {
    read_stall(word, words, into.stall);
  } else if (word.text == "queue") {
    read_queue(word, words, into.queue);
  } else if (word.text == "mtu") {
    words.once(word, "mtu");
    into.mtu = static_cast<std::uint64_t>(words.count("the MTU in bytes", kMtuMin, 65'535));
  } else if (word.text == "truncate") {
    read_truncate(word, words, into);
  } else if (word.text == "dscp-clear") {
    words.once(word, "dscp-clear");
    into.dscp_clear = true;
  } else if (word.text == "order") {
    read_order(word, words, into);
  } else {
    return false;
  }
  return true;
}

std::string_view impairment_help() noexcept {
  return R"(Impairments (SPEC): tc's words, with tc's units (bare numbers: us, per cent, bit/s):
  delay MEAN [JITTER [CORRELATION]] [distribution normal|pareto|paretonormal|TABLE]
  loss SHARE [CORR] | loss state P13 [P31 [P32 [P23 [P14]]]] | loss gemodel P [R [1-H [1-K]]]
  ecn  duplicate SHARE [CORR]  corrupt SHARE [CORR]  reorder SHARE [CORR]  gap N  limit N
  rate RATE [OVERHEAD [CELL [CELL_OVERHEAD]]]
  slot MIN [MAX] [packets N] [bytes N] | slot distribution NAME MEAN JITTER ...
and our own, in mode exact:
  distribution uniform|gamma|lognormal   correlation-time TIME   floor SHARE (of the mean)
  histogram FILE   trace FILE [loop] [dither]   replay FILE (a recording)
  loss burst RATE LENGTH (as 0.2/s 200ms)   loss bitmap FILE
  loss gilbert-time GOOD BAD [LOSS_IN_BAD [LOSS_IN_GOOD]]
  stall RATE MEDIAN [SPREAD]   blackout FROM LENGTH (may be repeated)
  corrupt SHARE [CORR] payload   truncate SHARE [CORR] to BYTES   mtu BYTES   dscp-clear
  queue [packets N] [bytes N] [time T] [codel [target T] [interval T]]
  order keep|netem|swap SHARE depth N    keep: nothing overtakes (default)
Delays are one way. `mode netem-6.1` or `mode exact` may stand first.)";
}

}  // namespace palp::netem
