#include "common/io/process/system_text.h"

#include <system_error>

namespace palp::io {

std::string system_text(int error) {
  std::string text = std::generic_category().message(error);
  // Names such as "RFS" keep their capitals.
  const auto is_capital = [](char letter) { return letter >= 'A' && letter <= 'Z'; };
  if (text.size() > 1 && is_capital(text[0]) && !is_capital(text[1])) {
    text[0] = static_cast<char>(text[0] - 'A' + 'a');
  }
  return text;
}

}  // namespace palp::io
