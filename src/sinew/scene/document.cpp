#include "sinew/scene/document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sinew/base/text.h"

namespace sinew {

namespace {

// ---- limits ----

// The TOML library recurses over its result, so the depth is limited before it parses the text: the
// number of open arrays and braces, and the dots of one key. Strings and comments are followed only
// as far as necessary.
class DepthCheck {
 public:
  DepthCheck(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
        continue;
      }
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (c == '\n') {
        ++line_;
        line_start_ = at_ + 1;
      }
      if (c == '[' || c == '{') ++open_;
      if (c == ']' || c == '}') open_ = std::max(0, open_ - 1);
      if (c == '.') ++dots_;
      if (c == '=' || c == ',' || c == '\n' || c == '[' || c == '{') dots_ = 0;
      if (open_ > kMaxSceneDepth || dots_ > kMaxSceneDepth) refuse();
      ++at_;
    }
  }

 private:
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool multiline = text_.substr(at_, 3) == three;
    at_ += multiline ? 3 : 1;
    while (at_ < text_.size()) {
      if (text_[at_] == '\n') {
        if (!multiline) return;  // not TOML: the parser reports it
        ++line_;
        line_start_ = at_ + 1;
      }
      if (quote == '"' && text_[at_] == '\\') {
        at_ += 2;
      } else if (multiline ? text_.substr(at_, 3) == three : text_[at_] == quote) {
        at_ += multiline ? 3 : 1;
        return;
      } else {
        ++at_;
      }
    }
  }

  [[noreturn]] void refuse() const {
    throw Error(ErrorKind::input, fmt::format("nested more than {} deep", kMaxSceneDepth),
                "no key of a scene needs that: see docs/scene-format.md",
                {file_, line_, static_cast<int>(at_ - line_start_) + 1});
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t line_start_ = 0;
  int line_ = 1;
  int open_ = 0;
  int dots_ = 0;
};

// ---- from the TOML library's tree to ours ----

Location location(const toml::source_region& source, const std::string& file) {
  return {file, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

DocValue convert(const toml::node& node, const std::string& file);

DocValue convert_table(const toml::table& table, const std::string& file) {
  DocValue value;
  value.type = DocValue::Type::table;
  for (const auto& [key, child] : table)
    value.entries.push_back(
        {std::string(key.str()), convert(child, file), location(key.source(), file)});
  // The library sorts keys by name; a scene's bodies are numbered in the file's order.
  const auto place = [](const DocEntry& e) {
    return std::tie(e.where.line, e.where.column, e.key);
  };
  std::sort(value.entries.begin(), value.entries.end(),
            [&](const DocEntry& a, const DocEntry& b) { return place(a) < place(b); });
  return value;
}

DocValue convert(const toml::node& node, const std::string& file) {
  DocValue value;
  if (const auto* table = node.as_table()) {
    value = convert_table(*table, file);
  } else if (const auto* array = node.as_array()) {
    value.type = DocValue::Type::array;
    for (const toml::node& item : *array) value.items.push_back(convert(item, file));
  } else if (const auto* text = node.as_string()) {
    value.type = DocValue::Type::text;
    value.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.type = DocValue::Type::integer;
    value.integer = integer->get();
  } else if (const auto* number = node.as_floating_point()) {
    value.type = DocValue::Type::number;
    value.number = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    value.type = DocValue::Type::boolean;
    value.boolean = boolean->get();
  } else {
    throw Error(ErrorKind::input, "a date or a time: no key of a scene takes one",
                "put it in quotes if it is meant as text", location(node.source(), file));
  }
  value.where = location(node.source(), file);
  return value;
}

// ---- and back to text ----

bool bare(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), is_name_character);
}

std::string key_text(const std::string& key) {
  return bare(key) ? key : toml_text(key);
}

std::string number_text(double number) {
  if (std::isnan(number)) return "nan";
  std::string text = fmt::format("{}", number);
  if (text.find_first_of(".en") == std::string::npos)
    text += ".0";  // otherwise TOML reads an integer
  return text;
}

std::string inline_text(const DocValue& value) {
  std::string out;
  switch (value.type) {
    case DocValue::Type::boolean:
      return value.boolean ? "true" : "false";
    case DocValue::Type::integer:
      return fmt::format("{}", value.integer);
    case DocValue::Type::number:
      return number_text(value.number);
    case DocValue::Type::text:
      return toml_text(value.text);
    case DocValue::Type::array:
      for (const DocValue& item : value.items) out += (out.empty() ? "" : ", ") + inline_text(item);
      return '[' + out + ']';
    case DocValue::Type::table:
      for (const DocEntry& entry : value.entries)
        out += (out.empty() ? "" : ", ") + key_text(entry.key) + " = " + inline_text(entry.value);
      return out.empty() ? "{}" : "{ " + out + " }";
  }
  return out;
}

void write_table(const DocValue& table, const std::string& path, std::string& out) {
  const bool has_values = std::any_of(table.entries.begin(), table.entries.end(),
                                      [](const DocEntry& e) { return !e.value.is_table(); });
  if (!path.empty() && (has_values || table.entries.empty())) out += "\n[" + path + "]\n";
  for (const DocEntry& entry : table.entries)
    if (!entry.value.is_table())
      out += key_text(entry.key) + " = " + inline_text(entry.value) + '\n';
  for (const DocEntry& entry : table.entries)
    if (entry.value.is_table())
      write_table(entry.value,
                  path.empty() ? key_text(entry.key) : path + '.' + key_text(entry.key), out);
}

}  // namespace

std::string toml_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

const DocValue* DocValue::find(std::string_view key) const {
  for (const DocEntry& entry : entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

DocValue* DocValue::find(std::string_view key) {
  return const_cast<DocValue*>(static_cast<const DocValue*>(this)->find(key));
}

DocValue parse_document(std::string_view text, const std::string& file_name) {
  if (text.size() > kMaxSceneBytes)
    throw Error(ErrorKind::input,
                fmt::format("{} bytes: a scene has at most {}", text.size(), kMaxSceneBytes),
                "is this a scene? meshes belong into files of their own", {file_name, 0, 0});
  DepthCheck(text, file_name).run();
  try {
    DocValue root = convert_table(toml::parse(text, file_name), file_name);
    root.where.file = file_name;
    return root;
  } catch (const toml::parse_error& error) {
    throw Error(ErrorKind::input, std::string(error.description()),
                "scenes are TOML: strings in quotes, key = value, [table] (docs/scene-format.md)",
                location(error.source(), file_name));
  }
}

std::string write_document(const DocValue& root) {
  std::string out;
  write_table(root, "", out);
  return out;
}

std::string describe(const DocValue& value) {
  switch (value.type) {
    case DocValue::Type::boolean:
    case DocValue::Type::integer:
    case DocValue::Type::number:
    case DocValue::Type::text: {
      const std::string text = inline_text(value);
      if (text.size() <= 60) return text;
      std::size_t end = 57;  // not within a UTF-8 character
      while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
      return text.substr(0, end) + "...";
    }
    case DocValue::Type::array:
      return fmt::format("an array of {}", value.items.size());
    case DocValue::Type::table:
      return "a table";
  }
  return {};
}

}  // namespace sinew
