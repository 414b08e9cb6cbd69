#include "study/letters.h"

#include <algorithm>
#include <utility>

#include "common/config/json.h"
#include "study/schedule.h"

namespace palp::study {

using config::Json;

Letters drawn_letters(std::size_t conditions, std::uint64_t number) {
  constexpr std::uint64_t kLetters = 0x6c65747465727300;
  return drawn_order(conditions, number, kLetters);
}

std::string key_text(const Study& study, const Letters& letters, const std::string& salt) {
  Json names = Json::object();
  for (std::size_t i = 0; i < letters.size(); ++i) {
    names[condition_code(i)] = study.conditions[letters[i]].name;
  }
  Json out{{"schema", "palp.study_key/1"}};
  out["letters"] = std::move(names);
  out["salt"] = salt;
  return out.dump(2) + "\n";
}

Result<Letters> parse_key(std::string_view text, const std::string& name, const Study& study) {
  const Json key = Json::parse(text);
  const Json& names = key.at_or_null("letters");
  Letters out;
  for (std::size_t i = 0; i < study.conditions.size(); ++i) {
    const auto said = names.at_or_null(condition_code(i)).text();
    const auto at = std::ranges::find_if(
        study.conditions, [&](const Condition& one) { return said && one.name == *said; });
    const auto number = static_cast<std::size_t>(at - study.conditions.begin());
    if (at == study.conditions.end() || std::ranges::find(out, number) != out.end()) {
      return fail(name + " does not give each condition of the study file its letter");
    }
    out.push_back(number);
  }
  return out;
}

Study lettered(Study study, const Letters& letters) {
  std::vector<Condition> conditions;
  for (const std::size_t of : letters) conditions.push_back(study.conditions[of]);
  study.conditions = std::move(conditions);
  return study;
}

}  // namespace palp::study
