// Goal: session files are read completely by readers that are not ours.
// Method: write files, whole and cut off, and open them with npm's @mcap/core and protobufjs, which
// know nothing but the schemas embedded in the file; compare the counts with the writer's.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/record/session_reader.h"
#include "common/record/session_writer.h"
#include "tests/common/record/record_samples.h"

namespace palp::record {
namespace {

namespace fs = std::filesystem;
using test::at_ms;

struct Answer {
  int status{};
  std::string output;
};

Answer run(const std::string& command) {
  Answer answer;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    answer.output.append(buffer.data(), size);
  }
  answer.status = ::pclose(pipe);
  return answer;
}

class IndependentReaderTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const fs::path build{PALP_READER_BUILD};
    fs::create_directories(build);
    for (const char* name : {"package.json", "package-lock.json", "read_with_mcap_core.mjs"}) {
      fs::copy_file(
          fs::path{PALP_READER_SOURCE} / name, build / name, fs::copy_options::overwrite_existing);
    }
    if (run("node --version").status != 0) {
      reason_ = "node is not installed (Debian: apt install nodejs npm)";
    } else if (!fs::exists(build / "node_modules" / "@mcap" / "core")) {
      const Answer install =
          run("cd '" + build.string() + "' && npm ci --ignore-scripts --no-audit --no-fund");
      reason_ =
          install.status == 0 ? "" : "npm ci failed, is the registry reachable? " + install.output;
    }
  }

  void SetUp() override {
    if (!reason_.empty()) {
      GTEST_SKIP() << reason_;
    }
    path_ = (fs::path{PALP_READER_BUILD} /
             (std::string{testing::UnitTest::GetInstance()->current_test_info()->name()} + ".mcap"))
                .string();
    fs::remove(path_);
  }

  [[nodiscard]] Answer read(const std::string& options = "") const {
    return run("cd '" PALP_READER_BUILD "' && node read_with_mcap_core.mjs '" + path_ + "' " +
               options);
  }

  std::string path_;

 private:
  static inline std::string reason_;  ///< why nothing can be tested; empty: all is there
};

/// Three seconds of everything a surgeon's site writes.
void write_session(SessionWriter& writer, int ticks) {
  for (int k = 0; k < ticks; ++k) {
    writer.write(test::tick(k));
    writer.write(Arrived{.at = at_ms(k),
                         .incoming = {.sample = {.payload = ModelPayload{.version = 2}},
                                      .number = static_cast<std::uint64_t>(k)}});
    if (k % 100 == 0) {
      writer.write(LinkStatus{.at = at_ms(k), .health = {.state = LinkState::Live}});
      writer.write(Note{.at = at_ms(k), .code = 39, .detail = 2});
      writer.write(Transition{at_ms(k), SiteState::Hold, SiteState::Engaged, 10});
    }
    if (k % 1000 == 0) {
      writer.write(DepthArrived{.at = at_ms(k), .report = {.number = 1, .depth = 0.01}});
    }
  }
}

TEST_F(IndependentReaderTest, ReadsEveryMessageWithTheEmbeddedSchemas) {
  auto sink = FileSink::create(path_);
  ASSERT_TRUE(sink);
  SessionWriter writer{*sink,
                       {.site = link::Role::Surgeon,
                        .metadata = {{"seed", "42"}},
                        .attachments = {{"config.textproto", "text/plain", "a: 1\n"}}}};
  write_session(writer, 3000);
  writer.close();

  const Answer answer = read();
  ASSERT_EQ(answer.status, 0) << answer.output;
  const auto seen = nlohmann::json::parse(answer.output);
  EXPECT_EQ(seen["messages"], writer.messages());
  EXPECT_EQ(seen["topics"]["surgeon/tick"], 3000);
  EXPECT_EQ(seen["topics"]["surgeon/tick_view"], writer.counts().views);
  EXPECT_EQ(seen["topics"]["surgeon/arrived"], 3000);
  EXPECT_EQ(seen["topics"]["surgeon/link"], 30);
  EXPECT_EQ(seen["topics"]["surgeon/event"], 60);
  EXPECT_EQ(seen["topics"]["surgeon/log"], 60);
  EXPECT_EQ(seen["first"]["surgeon/log"]["level"], "INFO");
  EXPECT_EQ(seen["first"]["surgeon/log"]["message"], "next phase of the script (2)");
  EXPECT_EQ(seen["first"]["surgeon/log"]["name"], "surgeon");
  EXPECT_EQ(seen["topics"]["surgeon/depth"], 3);
  EXPECT_EQ(seen["attachments"], nlohmann::json::array({"config.textproto"}));
  EXPECT_EQ(seen["metadata"]["palp"]["seed"], "42");
  EXPECT_EQ(seen["first"]["surgeon/tick"]["state"], "ENGAGED");
  EXPECT_EQ(seen["first"]["surgeon/tick"]["force_n"], 0.25);
  EXPECT_EQ(seen["first"]["surgeon/event"]["text"], "next phase of the script");
}

TEST_F(IndependentReaderTest, ReadsAsMuchOfACutOffFileAsWeDo) {
  MemorySink memory;
  {
    SessionWriter writer{memory, {.site = link::Role::Surgeon}};
    write_session(writer, 3000);
  }
  const auto half = memory.bytes().first(memory.bytes().size() * 6 / 10);
  auto sink = FileSink::create(path_);
  ASSERT_TRUE(sink && sink->write(half));
  SessionReader ours{half};
  while (ours.next()) {
  }
  ASSERT_GT(ours.report().messages, 0u);

  const Answer answer = read("--cut-off");
  ASSERT_EQ(answer.status, 0) << answer.output;
  const auto seen = nlohmann::json::parse(answer.output);
  EXPECT_FALSE(seen["closed"]);
  EXPECT_EQ(seen["messages"], ours.report().messages);
}

}  // namespace
}  // namespace palp::record
