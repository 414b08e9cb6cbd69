#include "tests/house/source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>

namespace palp::house {
namespace {

bool alphanumeric(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// Splits a C++ text into code and comments of the same length.
class Splitter {
 public:
  explicit Splitter(std::string_view text)
      : text_{text}, code_(text.size(), ' '), comments_(text.size(), ' ') {}

  void run() {
    while (at_ < text_.size()) {
      if (starts("//")) {
        comment(text_.find('\n', at_));
      } else if (starts("/*")) {
        const std::size_t end = text_.find("*/", at_ + 2);
        comment(end == std::string_view::npos ? end : end + 2);
      } else if (starts("R\"") && (at_ == 0 || !alphanumeric(text_[at_ - 1]))) {
        raw_literal();
      } else if (text_[at_] == '"' || (text_[at_] == '\'' && !separates_digits())) {
        literal(text_[at_]);
      } else if (text_[at_] == '\n') {
        keep_line_end();
      } else {
        keep(code_);
      }
    }
  }

  [[nodiscard]] const std::string& code() const { return code_; }
  [[nodiscard]] const std::string& comments() const { return comments_; }

 private:
  [[nodiscard]] bool starts(std::string_view with) const {
    return text_.substr(at_).starts_with(with);
  }
  [[nodiscard]] bool separates_digits() const {  // 40'000
    return at_ > 0 && at_ + 1 < text_.size() && alphanumeric(text_[at_ - 1]) &&
           alphanumeric(text_[at_ + 1]);
  }
  void keep(std::string& into) {
    into[at_] = text_[at_];
    ++at_;
  }
  void keep_line_end() {
    if (text_[at_] == '\n') code_[at_] = comments_[at_] = '\n';
    ++at_;
  }
  void comment(std::size_t end) {
    end = std::min(end, text_.size());
    while (at_ < end) {
      if (text_[at_] == '\n') {
        keep_line_end();
      } else {
        keep(comments_);
      }
    }
  }
  void literal(char quote) {
    keep(code_);
    while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') {
      at_ += text_[at_] == '\\' ? std::size_t{2} : std::size_t{1};
    }
    if (at_ < text_.size()) keep(code_);
  }
  void raw_literal() {
    const std::size_t open = text_.find('(', at_);
    if (open == std::string_view::npos) {
      at_ = text_.size();
      return;
    }
    const std::string close = ")" + std::string{text_.substr(at_ + 2, open - at_ - 2)} + "\"";
    std::size_t end = text_.find(close, open);
    end = end == std::string_view::npos ? text_.size() : end + close.size();
    while (at_ < end) keep_line_end();
  }

  std::string_view text_;
  std::size_t at_{};
  std::string code_;
  std::string comments_;
};

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

bool skipped_folder(const std::string& name) {
  constexpr std::array kFolders{"build", "out", "node_modules", ".git", ".cache"};
  return std::ranges::find(kFolders, name) != kFolders.end();
}

}  // namespace

bool Source::is_under(std::string_view folder) const {
  return path.size() > folder.size() && path.starts_with(folder) && path[folder.size()] == '/';
}

Source make_source(std::string path, std::string_view text) {
  Source source;
  source.path = std::move(path);
  source.size = text.size();
  if (text.find('\0') != std::string_view::npos) return source;
  source.lines = split_lines(text);
  if (!source.is_code()) return source;
  Splitter splitter{text};
  splitter.run();
  source.code = split_lines(splitter.code());
  source.comments = split_lines(splitter.comments());
  return source;
}

std::vector<Include> includes(const Source& source) {
  std::vector<Include> found;
  for (std::size_t i = 0; i < source.code.size(); ++i) {
    if (!source.code[i].starts_with("#include")) continue;
    const std::string& line = source.lines[i];
    const std::size_t begin = line.find_first_of("\"<");
    if (begin == std::string::npos) continue;
    const bool quoted = line[begin] == '"';
    const std::size_t end = line.find(quoted ? '"' : '>', begin + 1);
    if (end == std::string::npos) continue;
    found.push_back({line.substr(begin + 1, end - begin - 1), i + 1, quoted});
  }
  return found;
}

std::vector<Source> read_tree(const std::filesystem::path& root) {
  std::vector<Source> sources;
  std::filesystem::recursive_directory_iterator entry{root};
  for (; entry != std::filesystem::recursive_directory_iterator{}; ++entry) {
    if (entry->is_directory() && skipped_folder(entry->path().filename().string())) {
      entry.disable_recursion_pending();
    }
    if (!entry->is_regular_file() || entry->path().filename() == ".git") continue;
    std::ifstream file{entry->path(), std::ios::binary};
    const std::string text{std::istreambuf_iterator<char>{file}, {}};
    sources.push_back(make_source(entry->path().lexically_relative(root).generic_string(), text));
  }
  std::ranges::sort(sources, {}, &Source::path);
  return sources;
}

std::string listing(const Violations& violations) {
  std::string text;
  for (const Violation& violation : violations) {
    text +=
        violation.path + ":" + std::to_string(violation.line) + ": " + violation.sentence + "\n";
  }
  return text;
}

}  // namespace palp::house
