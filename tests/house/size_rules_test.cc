#include "tests/house/size_rules.h"

#include <string>

#include <gtest/gtest.h>

namespace palp::house {
namespace {

using Check = Violations (*)(const Source&);

/// Lines where the rule fires, e.g. "2 5".
std::string fires(Check check, const std::string& text) {
  std::string lines;
  for (const Violation& violation : check(make_source("common/core/a.cc", text))) {
    lines += (lines.empty() ? "" : " ") + std::to_string(violation.line);
  }
  return lines;
}

std::string repeated(int count, const std::string& line) {
  std::string text;
  for (int i = 0; i < count; ++i) text += line;
  return text;
}

/// As many lines as asked for, braces and all.
std::string function(const std::string& head, int lines) {
  return head + " {\n" + repeated(lines - 2, "  if (a) { b({c}); }\n") + "}\n";
}

TEST(SizeRulesTest, AFunctionHasSixtyLines) {
  for (const std::string head : {"int f(int a)", "TEST(A, B)", "template <class T> T A<T>::f()"}) {
    EXPECT_EQ(fires(long_functions, function(head, 60)), "") << head;
    EXPECT_EQ(fires(long_functions, "\n" + function(head, 61)), "2") << head;
  }
}

TEST(SizeRulesTest, ItBeginsWithItsHeadAndCountsItsInitializers) {
  const std::string head = "A::A(int a)\n    : b_{a},\n      c_{d(), {}}";
  EXPECT_EQ(fires(long_functions, function(head, 58)), "");
  EXPECT_EQ(fires(long_functions, function(head, 59)), "1");
}

TEST(SizeRulesTest, FunctionsOfAClassAreFoundTheClassItselfIsNone) {
  const std::string inside = function("int f() const", 61);
  EXPECT_EQ(
      fires(long_functions, "namespace n {\nclass A final : public B {\n" + inside + "};\n}\n"),
      "3");
  EXPECT_EQ(fires(long_functions, "struct A {\n" + repeated(100, "  int f();\n") + "};\n"), "");
  EXPECT_EQ(fires(long_functions, "namespace n {\n" + repeated(100, "int f();\n") + "}\n"), "");
  EXPECT_EQ(
      fires(long_functions, "constexpr std::array k{\n" + repeated(99, "  A{f(1)},\n") + "};\n"),
      "");
}

TEST(SizeRulesTest, AListSaysThatItIsOne) {
  const std::string table = function("const Table& table()", 99);
  EXPECT_EQ(fires(long_functions, table), "1");
  EXPECT_EQ(fires(long_functions, "/// One list.\n/// Its rows.\n" + table), "");
  EXPECT_EQ(fires(long_functions, "/// One list.\nint a;\n" + table), "3");
}

std::string members(int count) { return repeated(count, "  double a_{};  ///< [m]\n"); }

TEST(SizeRulesTest, AClassHasTwentyFiveMembers) {
  for (const std::string head :
       {"struct A", "class A final : public B", "template <class T>\nclass A"}) {
    EXPECT_EQ(fires(crowded_classes, head + " {\n" + members(25) + "};\n"), "") << head;
    EXPECT_EQ(fires(crowded_classes, head + " {\n" + members(26) + "};\n"), "1") << head;
  }
  EXPECT_EQ(fires(crowded_classes, "/// One list.\nstruct A {\n" + members(26) + "};\n"), "");
}

TEST(SizeRulesTest, EveryKindOfDataCounts) {
  for (const std::string data : {"A a_;",
                                 "const A* a_;",
                                 "A& a_;",
                                 "std::array<A, (1 + 2)> a_{};",
                                 "std::function<void(A)> a_;",
                                 "alignas(64) std::array<A, 2> a_{};",
                                 "A a_ = f(3);",
                                 "A a_{f(B{})};",
                                 "mutable A a_{\n1};",
                                 "private: A a_;"}) {
    EXPECT_EQ(fires(crowded_classes, "struct S {\n" + members(25) + data + "\n};\n"), "1") << data;
  }
}

TEST(SizeRulesTest, NothingElseOfAClassCounts) {
  for (const std::string other : {"void f();",
                                  "A f() const { return a_; }",
                                  "A f() const noexcept { A a; B b; return a; }",
                                  "S(int a) : a_{a}, b_{2} {}",
                                  "S& operator=(const S&) = delete;",
                                  "static constexpr A a = 2;",
                                  "using A = B;",
                                  "friend class A;",
                                  "class A;",
                                  "enum class E : int { A, B };",
                                  "struct B { int a; int b; };",
                                  "class C : public B { int a; };",
                                  "// int a;"}) {
    EXPECT_EQ(fires(crowded_classes, "struct S {\n" + members(25) + other + "\n};\n"), "") << other;
  }
}

}  // namespace
}  // namespace palp::house
