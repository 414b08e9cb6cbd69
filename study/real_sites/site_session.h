#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/process/child_program.h"
#include "common/io/process/message_pipe.h"
#include "common/record/notes.h"
#include "study/person_trial.h"
#include "study/real_sites/relay_line.h"
#include "study/study_file.h"

/// Both sites of a session, as programs of this machine.
namespace palp::study {

/// The hand's device, as for palp-surgeon.
struct HandSetting {
  std::string master{"pointer"};
  std::string devices{};             ///< file; empty: none is needed
  std::uint16_t monitor_port{8080};  ///< 0: any free one
};

struct SiteSetting {
  std::string programs{};  ///< folder of palp-surgeon, palp-patient, palp-netem
  std::string work{};      ///< folder of one's own: what the programs read and say
  std::string tissue{};    ///< as tissue_text() has it
  bool changes_delay{};    ///< a relay stands between the sites, for delay()
  std::string traces{};    ///< beginning of the session files' paths
  HandSetting hand{};
};

/// An answer as it came from the page, or by a button of the hand's device.
struct SiteAnswer {
  std::uint32_t trial{};   ///< as show() numbered it; 0: by a button, of the trial that asks
  std::uint32_t choice{};  ///< from 1
  TimePoint at{};
};

/// palp-patient with a simulated tissue and palp-surgeon, which what arrives at each reaches as the
/// condition's link lets it; between them palp-netem relay, where delays change. They end with it.
/// Blocks while they start. Thread: its maker's.
class SiteSession {
 public:
  /// Waits until the page can be opened. The error is a CannotOpen with the program's own sentence.
  [[nodiscard]] static Result<SiteSession> start(const Condition& condition,
                                                 const SiteSetting& setting);

  /// Of the participant's page.
  [[nodiscard]] const std::string& page() const noexcept { return page_; }
  /// Takes what came; waits 20 ms where nothing has.
  void listen();
  /// As last heard.
  [[nodiscard]] const SiteNews& news() const noexcept { return news_; }
  /// The oldest that was not taken.
  [[nodiscard]] std::optional<SiteAnswer> take_answer() noexcept;
  void send_place(const StagePlace& place);
  /// The way down takes so much longer [ms] from now on, within a second. Of sessions that change
  /// delays.
  void delay(double milliseconds);
  /// JSON for the page.
  void show(const std::string& view);
  void note(record::NoteCode code, double detail, TimePoint at);
  /// Nothing: both sites run. Else why not.
  [[nodiscard]] std::optional<Error> fault();
  /// Lets both sites close their files.
  void stop();

 private:
  /// What stands between the sites.
  struct Relay {
    io::ChildProgram program;
    RelayLine line;
    std::string address;
  };
  [[nodiscard]] static Result<Relay> start_relay(const SiteSetting& setting,
                                                 const std::string& patient,
                                                 io::MessagePipe& pipe);
  SiteSession(io::ChildProgram patient, io::ChildProgram surgeon, io::MessagePipe pipe) noexcept
      : patient_{std::move(patient)}, surgeon_{std::move(surgeon)}, pipe_{std::move(pipe)} {}
  void hear(const std::string& message);

  io::ChildProgram patient_;
  io::ChildProgram surgeon_;
  std::optional<Relay> relay_;
  double delay_{};                       ///< [ms], as the relay was told
  std::optional<io::MessagePipe> pipe_;  ///< none once it was stopped
  std::string log_;                      ///< of the surgeon's program
  std::string page_;
  SiteNews news_;
  std::optional<SiteAnswer> answer_;
};

}  // namespace palp::study
