// Input: a letter for the document (s, p or l), then lines: settings in text form; a line that
// begins with "--set " is an override, applied where it stands.
#include <algorithm>
#include <string>

#include "common/config/document.h"
#include "common/core/check.h"
#include "tests/fuzz/fuzz.h"

namespace palp::config {
namespace {

constexpr std::string_view kSet = "--set ";

Document fresh_document(char letter) {
  if (letter == 's') return surgeon_document();
  if (letter == 'p') return patient_document();
  return scenario_document();
}

void sentence_laws(const std::string& text) {
  PALP_CHECK(!text.empty(), "a refusal says why");
  PALP_CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }),
             "a sentence is one printable line, whatever was in the input");
}

/// Applies one piece; @returns whether it was taken.
bool apply(std::string_view piece, Document& document) {
  const std::string before = document.text();
  const bool single = piece.starts_with(kSet);
  const auto result =
      single ? document.set(piece.substr(kSet.size())) : document.merge(piece, "fuzz");
  if (result) return true;
  sentence_laws(result.error().text);
  PALP_CHECK(single || result.error().text.starts_with("fuzz:"), "a refusal names the file");
  PALP_CHECK(document.text() == before, "a refusal changes nothing");
  return false;
}

void round_trip(const Document& document, char letter) {
  Document again = fresh_document(letter);
  const std::string text = document.text();
  PALP_CHECK(again.merge(text, "again").has_value(), "the effective settings are understood");
  PALP_CHECK(again.text() == text, "the effective settings read back as they are");
  PALP_CHECK(again.hash() == document.hash(), "equal settings have equal hashes");
  const auto sound = document.check();
  PALP_CHECK(again.check().has_value() == sound.has_value(), "equal settings are equally sound");
  if (!sound) sentence_laws(sound.error().text);
}

/// The next piece: one override, or all lines up to the next one.
std::string_view take_piece(std::string_view& rest) {
  std::size_t end = rest.find('\n');
  if (!rest.starts_with(kSet)) {
    end = rest.find("\n--set ");
  }
  const std::string_view piece = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return piece;
}

}  // namespace
}  // namespace palp::config

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = palp::fuzz::as_text(data, size);
  if (rest.empty()) return 0;
  const char letter = rest.front();
  rest.remove_prefix(1);
  palp::config::Document document = palp::config::fresh_document(letter);
  bool changed = false;
  for (int pieces = 0; pieces < 8 && !rest.empty(); ++pieces) {
    changed = palp::config::apply(palp::config::take_piece(rest), document) || changed;
  }
  if (changed) palp::config::round_trip(document, letter);
  return 0;
}
