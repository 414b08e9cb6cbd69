#include "common/config/json.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "common/core/check.h"

namespace palp::config {

/// From and to the library's own value.
struct JsonText {
  using Library = nlohmann::ordered_json;

  static Library library(const Json& json) {
    if (const auto* list = std::get_if<Json::Array>(&json.value_)) {
      Library out = Library::array();
      for (const Json& part : *list) out.push_back(library(part));
      return out;
    }
    if (const auto* object = std::get_if<Json::Object>(&json.value_)) {
      Library out = Library::object();
      for (std::size_t i = 0; i < object->names.size(); ++i) {
        out[object->names[i]] = library(object->values[i]);
      }
      return out;
    }
    return scalar(json);
  }

  static Json own(const Library& in) {
    Json out;
    if (in.is_array()) {
      out = Json::array();
      for (const Library& part : in) out.push_back(own(part));
    } else if (in.is_object()) {
      out = Json::object();
      for (const auto& [name, part] : in.items()) out[name] = own(part);
    } else if (in.is_string()) {
      out = in.get_ref<const std::string&>();
    } else if (in.is_boolean()) {
      out = in.get<bool>();
    } else if (in.is_number_unsigned()) {
      out = in.get<std::uint64_t>();
    } else if (in.is_number_integer()) {
      out = in.get<std::int64_t>();
    } else if (in.is_number_float()) {
      out = in.get<double>();
    }
    return out;
  }

 private:
  static Library scalar(const Json& json) {
    if (const auto* truth = std::get_if<bool>(&json.value_)) return *truth;
    if (const auto* whole = std::get_if<std::int64_t>(&json.value_)) return *whole;
    if (const auto* natural = std::get_if<std::uint64_t>(&json.value_)) return *natural;
    if (const auto* real = std::get_if<double>(&json.value_)) return *real;
    if (const auto* text = std::get_if<std::string>(&json.value_)) return *text;
    return nullptr;
  }
};

Json::Json(std::initializer_list<Json> parts) {
  const auto is_member = [](const Json& part) {
    const auto* const pair = std::get_if<Array>(&part.value_);
    return pair != nullptr && pair->size() == 2 &&
           std::holds_alternative<std::string>(pair->front().value_);
  };
  if (!std::all_of(parts.begin(), parts.end(), is_member)) {
    value_ = Array(parts);
    return;
  }
  value_ = Object{};
  for (const Json& part : parts) {
    const Array& pair = std::get<Array>(part.value_);
    (*this)[std::get<std::string>(pair.front().value_)] = pair.back();
  }
}

Json Json::array() {
  Json out;
  out.value_ = Array{};
  return out;
}

Json Json::object() {
  Json out;
  out.value_ = Object{};
  return out;
}

Json Json::parse(std::string_view text) {
  return JsonText::own(JsonText::Library::parse(text, nullptr, false));
}

bool Json::is_null() const noexcept { return std::holds_alternative<std::nullptr_t>(value_); }
bool Json::is_object() const noexcept { return std::holds_alternative<Object>(value_); }
bool Json::is_unsigned() const noexcept { return std::holds_alternative<std::uint64_t>(value_); }

std::optional<double> Json::number() const noexcept {
  if (const auto* real = std::get_if<double>(&value_)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*whole);
  if (const auto* natural = std::get_if<std::uint64_t>(&value_)) {
    return static_cast<double>(*natural);
  }
  return std::nullopt;
}

std::optional<bool> Json::truth() const noexcept {
  const auto* const truth = std::get_if<bool>(&value_);
  return truth != nullptr ? std::optional{*truth} : std::nullopt;
}

std::optional<std::string_view> Json::text() const noexcept {
  const auto* const text = std::get_if<std::string>(&value_);
  return text != nullptr ? std::optional<std::string_view>{*text} : std::nullopt;
}

std::span<const Json> Json::parts() const noexcept {
  const auto* const list = std::get_if<Array>(&value_);
  return list != nullptr ? std::span<const Json>{*list} : std::span<const Json>{};
}

std::span<const std::string> Json::names() const noexcept {
  const auto* const object = std::get_if<Object>(&value_);
  return object != nullptr ? std::span<const std::string>{object->names}
                           : std::span<const std::string>{};
}

const Json* Json::find(std::string_view name) const noexcept {
  const auto* const object = std::get_if<Object>(&value_);
  if (object == nullptr) return nullptr;
  const auto at = std::find(object->names.begin(), object->names.end(), name);
  if (at == object->names.end()) return nullptr;
  return &object->values[static_cast<std::size_t>(at - object->names.begin())];
}

Json::Object& Json::as_object() {
  if (is_null()) value_ = Object{};
  auto* const object = std::get_if<Object>(&value_);
  PALP_CHECK(object != nullptr, "only an object has members");
  return *object;
}

bool Json::contains(std::string_view name) const noexcept { return find(name) != nullptr; }

Json& Json::operator[](std::string_view name) {
  Object& object = as_object();
  const auto at = std::find(object.names.begin(), object.names.end(), name);
  const auto index = static_cast<std::size_t>(at - object.names.begin());
  if (at == object.names.end()) {
    object.names.emplace_back(name);
    object.values.emplace_back();
  }
  return object.values[index];
}

const Json& Json::operator[](std::string_view name) const {
  const Json* const found = find(name);
  PALP_CHECK(found != nullptr, "the object has this member");
  return *found;
}

const Json& Json::at_or_null(std::string_view name) const noexcept {
  static const Json none;
  const Json* const found = find(name);
  return found != nullptr ? *found : none;
}

void Json::update(const Json& other) {
  const auto* const object = std::get_if<Object>(&other.value_);
  PALP_CHECK(object != nullptr, "only an object has members");
  for (std::size_t i = 0; i < object->names.size(); ++i) {
    (*this)[object->names[i]] = object->values[i];
  }
}

Json& Json::operator[](std::size_t index) {
  if (is_null()) value_ = Array{};
  auto* const list = std::get_if<Array>(&value_);
  PALP_CHECK(list != nullptr, "only a list has an index");
  if (index >= list->size()) list->resize(index + 1);
  return (*list)[index];
}

void Json::push_back(Json part) {
  if (is_null()) value_ = Array{};
  auto* const list = std::get_if<Array>(&value_);
  PALP_CHECK(list != nullptr, "only a list takes parts");
  list->push_back(std::move(part));
}

std::string Json::dump(int indent) const {
  return JsonText::library(*this).dump(
      indent, ' ', false, JsonText::Library::error_handler_t::replace);
}

}  // namespace palp::config
