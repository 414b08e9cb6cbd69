#include "tests/house/rules.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/house/arrows.h"
#include "tests/house/source.h"
#include "tests/house/tree_rules.h"

// Each rule finds what is planted here, and lets pass what only looks alike. Words that must not
// stand in the tree are put together from halves.
namespace palp::house {
namespace {

using Check = Violations (*)(const Source&);

/// Lines where the rule fires, e.g. "2 5".
std::string fires(Check check, const std::string& path, std::string_view text) {
  std::string lines;
  for (const Violation& violation : check(make_source(path, text))) {
    EXPECT_EQ(violation.path, path);
    EXPECT_FALSE(violation.sentence.empty());
    lines += (lines.empty() ? "" : " ") + std::to_string(violation.line);
  }
  return lines;
}

TEST(SourceTest, CommentsAndLiteralsAreNoCode) {
  const Source source = make_source("common/core/a.cc",
                                    "int a;  // rand()\n"
                                    "/* rand()\n rand() */ int b;\n"
                                    "const char* c = \"rand() \\\" rand()\"; int d = 40'000;\n"
                                    "auto e = R\"(rand()\n\" rand())\"; char f = '\"'; int g;\n");
  EXPECT_EQ(fires(randomness, "common/core/a.cc", "rand();"), "1");
  EXPECT_TRUE(randomness(source).empty()) << listing(randomness(source));
  EXPECT_NE(source.code[2].find("int b;"), std::string::npos);
  EXPECT_NE(source.code[3].find("40'000"), std::string::npos);
  EXPECT_NE(source.code[5].find("int g;"), std::string::npos);
  EXPECT_NE(source.comments[1].find("rand()"), std::string::npos);
}

TEST(ArrowsTest, WhatTheTableDoesNotNameIsForbidden) {
  const auto allowed = [](const std::string& from, const std::string& to) {
    return fires(forbidden_arrows, from, "#include \"" + to + "\"\n").empty();
  };
  EXPECT_TRUE(allowed("common/link/link.cc", "common/core/time.h"));
  EXPECT_TRUE(allowed("common/link/link.cc", "common/link/link.h"));
  EXPECT_FALSE(allowed("common/core/time.h", "common/link/link.h"));
  EXPECT_FALSE(allowed("common/coupling/direct.h", "common/link/link.h"));
  EXPECT_TRUE(allowed("common/record/recorder.h", "common/link/telegram.h"));
  EXPECT_FALSE(allowed("common/link/telegram.h", "common/record/recorder.h"));
  EXPECT_TRUE(allowed("netem/model/pipe.h", "common/link/transport.h"));
  EXPECT_FALSE(allowed("netem/model/pipe.h", "common/link/telegram.h"));
  EXPECT_FALSE(allowed("netem/model/pipe.cc", "common/io/net/udp_socket.h"));
  EXPECT_TRUE(allowed("netem/relay/relay.cc", "common/io/net/udp_socket.h"));
  EXPECT_TRUE(allowed("common/io/net/datagram_socket.h", "common/io/net/endpoint.h"));
  EXPECT_FALSE(allowed("surgeon_site/surgeon_node.h", "patient_site/stage.h"));
  EXPECT_FALSE(allowed("surgeon_site/surgeon_node.cc", "common/io/net/udp_socket.h"));
  EXPECT_FALSE(allowed("surgeon_site/surgeon_node.cc", "common/config/config.h"));
  EXPECT_TRUE(allowed("surgeon_site/settings.cc", "common/config/config.h"));
  EXPECT_TRUE(allowed("surgeon_site/main.cc", "common/io/net/udp_socket.h"));
  EXPECT_TRUE(allowed("surgeon_site/main.cc", "netem/model/impaired_transport.h"));
  EXPECT_FALSE(allowed("surgeon_site/main.cc", "patient_site/stage.h"));
  EXPECT_TRUE(allowed("patient_site/devices/x.cc", "patient_site/stage.h"));
  EXPECT_FALSE(allowed("patient_site/devices/x.cc", "patient_site/patient_node.h"));
  EXPECT_TRUE(allowed("patient_site/patient_node.h", "depth/estimator.h"));
  EXPECT_FALSE(allowed("depth/fit.h", "patient_site/stage.h"));
  EXPECT_TRUE(allowed("lab/run/simulator.h", "surgeon_site/surgeon_node.h"));
  EXPECT_FALSE(allowed("lab/run/simulator.h", "surgeon_site/devices/x.h"));
  EXPECT_FALSE(allowed("lab/run/simulator.h", "common/io/realtime/steady_clock.h"));
  EXPECT_FALSE(allowed("review/check.cc", "lab/run/simulator.h"));
  EXPECT_FALSE(allowed("common/core/time.h", "tests/support/realtime_guard.h"));
  EXPECT_TRUE(allowed("tests/lab/a_test.cc", "lab/run/simulator.h"));
  EXPECT_FALSE(allowed("common/link/link.cc", "link.h"));
}

TEST(ArrowsTest, FileOutsideEveryRoomIsTold) {
  EXPECT_EQ(fires(forbidden_arrows, "attic/old.cc", ""), "0");
}

TEST(FencesTest, LibraryIsSeenOnlyBehindItsFence) {
  const auto allowed = [](const std::string& from, const std::string& include) {
    return fires(broken_fences, from, "#include " + include + "\n").empty();
  };
  EXPECT_TRUE(allowed("common/io/net/udp_socket.cc", "<boost/asio.hpp>"));
  EXPECT_FALSE(allowed("common/io/net/udp_socket.h", "<boost/asio.hpp>"));
  EXPECT_TRUE(allowed("common/link/codec_control.cc", "\"proto/link.pb.h\""));
  EXPECT_FALSE(allowed("common/link/codec.h", "\"proto/link.pb.h\""));
  EXPECT_FALSE(allowed("common/link/link.cc", "\"proto/link.pb.h\""));
  EXPECT_FALSE(allowed("lab/run/simulator.cc", "<google/protobuf/message.h>"));
  EXPECT_TRUE(allowed("common/record/mcap_writer.cc", "<zstd.h>"));
  EXPECT_FALSE(allowed("common/record/queue_recorder.cc", "<zlib.h>"));
  EXPECT_FALSE(allowed("lab/main.cc", "<CLI/CLI.hpp>"));
  EXPECT_TRUE(allowed("lab/main.cc", "<spdlog/spdlog.h>"));
  EXPECT_FALSE(allowed("lab/run/simulator.cc", "<fmt/format.h>"));
  EXPECT_FALSE(allowed("common/io/net/a.cc", "<readerwriterqueue/readerwriterqueue.h>"));
  EXPECT_FALSE(allowed("common/link/a.h", "<tl/expected.hpp>"));
  EXPECT_TRUE(allowed("common/config/json.cc", "<nlohmann/json.hpp>"));
  EXPECT_FALSE(allowed("lab/report/a.cc", "<nlohmann/json.hpp>"));
  EXPECT_FALSE(allowed("common/core/check.cc", "<gtest/gtest.h>"));
  EXPECT_FALSE(allowed("lab/run/simulator.cc", "<curl/curl.h>"));
  EXPECT_TRUE(allowed("lab/run/simulator.cc", "<vector>"));
  EXPECT_TRUE(allowed("common/io/net/a.cc", "<sys/socket.h>"));
  EXPECT_TRUE(allowed("tests/lab/a.cc", "<gtest/gtest.h>"));
}

TEST(RulesTest, ClocksAndSleepsAreFoundOutsideIo) {
  EXPECT_EQ(fires(clocks_and_sleeps,
                  "lab/run/simulator.cc",
                  "auto a = std::chrono::steady_clock::now();\n"
                  "clock_gettime(CLOCK_MONOTONIC, &b);\n"
                  "std::this_thread::sleep_for(c);\n"
                  "::nanosleep(&d, nullptr);\n"
                  "usleep(1);\n"
                  "sleep (1);\n"
                  "int sleep = 0;  // sleep(1)\n"),
            "1 2 3 4 5 6");
  EXPECT_EQ(fires(clocks_and_sleeps, "common/io/realtime/steady_clock.cc", "clock_gettime(a, &b);"),
            "");
  EXPECT_EQ(fires(clocks_and_sleeps, "tests/lab/a_test.cc", "usleep(1);"), "1");
}

TEST(RulesTest, RandomnessIsFoundEverywhere) {
  EXPECT_EQ(fires(randomness,
                  "tests/lab/a_test.cc",
                  "int a = rand();\nstd::mt19937 b;\nstd::random_device c;\n"
                  "std::normal_distribution<double> d;\nint operand(int);\n"),
            "1 2 3 4");
}

TEST(RulesTest, ThreadsAreFoundOutsideIo) {
  EXPECT_EQ(
      fires(threads, "lab/run/simulator.h", "std::jthread a;\nstd::thread b;\nstd::async(c);\n"),
      "1 2 3");
  EXPECT_EQ(fires(threads, "lab/run/simulator.h", "std::this_thread::yield();"), "");
  EXPECT_EQ(fires(threads, "common/io/realtime/background_loop.h", "std::jthread a;"), "");
  EXPECT_EQ(fires(threads, "tests/common/core/queues_test.cc", "std::thread a;"), "");
}

TEST(RulesTest, SharedOwnershipIsFound) {
  EXPECT_EQ(
      fires(shared_ownership, "lab/a.h", "std::shared_ptr<int> a;\nstd::unique_ptr<int> b;\n"),
      "1");
}

TEST(RulesTest, ATestsFilesAreItsOwn) {
  constexpr const char* kShared = "int a;\nauto b = testing::TempDir() + \"b\";\n";
  EXPECT_EQ(fires(temporary_files, "tests/lab/a_test.cc", kShared), "2");
  EXPECT_EQ(fires(temporary_files, "lab/a.cc", kShared), "");
}

TEST(RulesTest, UsingNamespaceIsFoundButForLiterals) {
  EXPECT_EQ(fires(using_namespace,
                  "lab/a.cc",
                  "using namespace std;\nusing namespace std::chrono_literals;\nusing std::abs;\n"),
            "1");
}

TEST(RulesTest, ConditionalCodeIsFound) {
  EXPECT_EQ(fires(conditional_code,
                  "lab/a.h",
                  "#pragma once\n#ifdef A\n#define B\n# if C\n#endif\n#include <if>\n"),
            "2 4");
}

TEST(RulesTest, ThrowIsFoundInAFileOfTheRealTimeThread) {
  EXPECT_EQ(fires(throw_on_rt, "netem/a.h", "/// Thread: rt.\nvoid f() {\n  throw 1;\n}\n"), "3");
  EXPECT_EQ(fires(throw_on_rt, "netem/a.h", "/// Thread: main.\nvoid f() { throw 1; }\n"), "");
  EXPECT_EQ(fires(throw_on_rt, "netem/a.h", "/// Thread: rt. Never throws: no throw.\n"), "");
}

TEST(RulesTest, MemberWithoutUnitIsFound) {
  EXPECT_EQ(fires(members_without_unit,
                  "lab/a.h",
                  "template <class T>\n"
                  "struct A {\n"
                  "  double bare{};\n"                        // 3
                  "  double good{};  ///< [m]\n"              // 4
                  "  /// [N], a comment above\n"              // 5
                  "  double above{};\n"                       // 6
                  "  double ratio{1.0};  ///< [-]\n"          // 7
                  "  std::array<double, 3> bare_array{};\n"   // 8
                  "  static constexpr double kBare = 1;\n"    // 9
                  "  double step(double input) noexcept {\n"  // 10
                  "    double local = input;\n"               // 11
                  "    return local;\n"                       // 12
                  "  }\n"                                     // 13
                  "  [[nodiscard]] double value() const;\n"   // 14
                  "  class B : public C<double> {\n"          // 15
                  "    double also_bare_;\n"                  // 16
                  "  };\n"                                    // 17
                  "  const double& reference;\n"              // 18
                  "};\n"                                      // 19
                  "inline double free_function() {\n"         // 20
                  "  double local = 1;\n"                     // 21
                  "  return local;\n"                         // 22
                  "}\n"),
            "3 8 9 16");
}

TEST(RulesTest, UnitAtTheEndOfANameIsAUnit) {
  EXPECT_EQ(fires(members_without_unit,
                  "lab/a.h",
                  "struct A {\n  double depth_mm{};\n  std::optional<double> rtt_ms{};\n"
                  "  double force_n = 0;\n  double items;\n};\n"),
            "5");
}

TEST(RulesTest, MembersOfSourcesAndTestsAreTheirOwnAffair) {
  EXPECT_EQ(fires(members_without_unit, "lab/a.cc", "struct A {\n  double bare{};\n};\n"), "");
  EXPECT_EQ(fires(members_without_unit, "tests/lab/a.h", "struct A {\n  double bare{};\n};\n"), "");
}

TEST(RulesTest, HeaderWithoutPragmaOnceIsFound) {
  EXPECT_EQ(fires(missing_pragma_once, "lab/a.h", "// #pragma once\n"), "1");
  EXPECT_EQ(fires(missing_pragma_once, "lab/a.h", "#pragma once\n"), "");
  EXPECT_EQ(fires(missing_pragma_once, "lab/a.cc", ""), "");
}

std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(RulesTest, FourHundredLinesPassAndOneMoreDoesNot) {
  EXPECT_EQ(fires(long_files, "lab/a.cc", repeated(400, "\n")), "");
  EXPECT_EQ(fires(long_files, "lab/a.cc", repeated(401, "\n")), "401");
  EXPECT_EQ(fires(long_files, "demo", "#!/bin/bash\n" + repeated(400, "\n")), "401");
  EXPECT_EQ(fires(long_files, "tests/lab/a_test.cc", repeated(450, "\n")), "");
  EXPECT_EQ(fires(long_files, "tests/lab/a_test.cc", repeated(451, "\n")), "451");
  EXPECT_EQ(fires(long_files, "README.md", repeated(401, "\n")), "");
}

TEST(RulesTest, HundredColumnsPassAndOneMoreDoesNot) {
  EXPECT_EQ(fires(long_lines, "lab/a.cc", repeated(100, "x")), "");
  EXPECT_EQ(fires(long_lines, "lab/a.cc", "\n" + repeated(101, "x")), "2");
  EXPECT_EQ(fires(long_lines, "lab/a.cc", "//" + repeated(98, "\xc2\xb5")), "");
  EXPECT_EQ(fires(long_lines, "table.csv", repeated(101, "x")), "");
}

TEST(RulesTest, OneMegabytePassesAndOneByteMoreDoesNot) {
  EXPECT_EQ(fires(heavy_files, "a.bin", std::string(1'000'000, '\0')), "");
  EXPECT_EQ(fires(heavy_files, "a.bin", std::string(1'000'001, '\0')), "0");
}

TEST(RulesTest, UnwantedWordsAreFoundInEveryText) {
  EXPECT_EQ(fires(unwanted_words,
                  "A.md",
                  "fine\nTO"
                  "DO\nFIX"
                  "ME\n/ho"
                  "me/me\n"),
            "2 3 4");
  EXPECT_EQ(fires(unwanted_words,
                  "lab/a.cc",
                  "// see /wo"
                  "rk/x\n"),
            "1");
}

TEST(TreeRulesTest, HeaderThatNoTestReadsIsFound) {
  const Source header = make_source("netem/model/impairment_model.h", "#pragma once\n");
  const Source list = make_source("netem/CMakeLists.txt", "");
  const Source test = make_source("tests/netem/a_test.cc", "#include \"netem/model/pipe.h\"\n");
  const Source other = make_source("tests/lab/a_test.cc", "#include \"netem/model/pipe.h\"\n");
  const Source pipe =
      make_source("netem/model/pipe.h", "#include \"netem/model/impairment_model.h\"\n");
  EXPECT_EQ(untested_headers({header, list}).size(), 1U);
  EXPECT_TRUE(untested_headers({header}).empty());                    // no such room yet
  EXPECT_TRUE(untested_headers({header, list, test, pipe}).empty());  // through pipe.h
  const Source beside =
      make_source("netem/model/pipe.cc", "#include \"netem/model/impairment_model.h\"\n");
  const Source bare_pipe = make_source("netem/model/pipe.h", "");
  EXPECT_TRUE(untested_headers({header, list, test, bare_pipe, beside}).empty());
  EXPECT_EQ(untested_headers({header, list, other, pipe}).size(), 1U);  // of another room
}

TEST(TreeRulesTest, SourceInNoListIsFound) {
  const Source source = make_source("netem/model/impairment_model.cc", "");
  const auto list = [](const std::string& text) {
    return make_source("netem/CMakeLists.txt", text);
  };
  const Source listed = list("palp_library(a SOURCES model/pipe.cc model/impairment_model.cc)");
  const Source other = list("palp_library(a SOURCES model/my_impairment_model.cc)");
  EXPECT_TRUE(unlisted_sources({source, listed}).empty());
  EXPECT_EQ(unlisted_sources({source, other}).size(), 1U);
  EXPECT_TRUE(unlisted_sources({source}).empty());  // no such room yet
}

TEST(TreeRulesTest, NameThatTwoSourcesOfAFolderGiveIsFound) {
  const auto unnamed = [](const std::string& path, const std::string& what) {
    return make_source(path, "namespace palp {\nnamespace {\n" + what + "\n}  // namespace\n}\n");
  };
  for (const std::string what : {"constexpr double kNear = 1;",
                                 "struct Row {",
                                 "std::string mm(double value) {",
                                 "constexpr std::array kAll{1, 2};"}) {
    const Source first = unnamed("fem/a.cc", what);
    EXPECT_EQ(repeated_names({first, unnamed("fem/b.cc", what)}).size(), 1U) << what;
    EXPECT_TRUE(repeated_names({first, unnamed("lab/b.cc", what)}).empty()) << what;
    EXPECT_TRUE(repeated_names({first, unnamed("tests/fem/b.cc", what)}).empty()) << what;
  }
  EXPECT_TRUE(repeated_names({unnamed("fem/a.cc", "double mm(int value) {"),
                              unnamed("fem/b.cc", "double mm(double value) {")})
                  .empty());
}

TEST(TreeRulesTest, CitedPageThatIsNotHereIsFound) {
  const std::string page = std::string{"guide"} + ".md";
  const Source source = make_source("lab/a.h", "// see " + page + "\n");
  EXPECT_EQ(missing_pages({source}).size(), 1U);
  EXPECT_TRUE(missing_pages({source, make_source("lab/" + page, "")}).empty());
  EXPECT_TRUE(missing_pages({make_source("lab/a.h", "// see WIRE.md\n")}).empty());
}

}  // namespace
}  // namespace palp::house
