#include "sinew/scene/overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "sinew/scene/keys.h"

namespace sinew {

namespace {

// The tables whose entries have names, the body first: `NAME.key` means a body's key if one has it.
constexpr std::array<std::string_view, 8> named_tables = {
    "body", "pin", "attachment", "distance", "force", "probe", "obstacle", "cut"};

using KeyPath = std::vector<std::string>;

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r\n") - begin + 1));
}

class Override {
 public:
  Override(DocValue& root, const std::string& text) : root_(root), where_{"--set " + text, 0, 0} {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw Error(ErrorKind::usage, "no '=' between the key and its value",
                  "write --set beam.young=20e3", where_);
    value_text_ = trimmed(std::string_view(text).substr(equals + 1));
    if (value_text_.empty())
      throw Error(ErrorKind::usage, "no value after '='", "an empty text is written as '\"\"'",
                  where_);
    std::string_view rest = std::string_view(text).substr(0, equals);
    while (true) {
      const std::size_t dot = rest.find('.');
      path_.push_back(trimmed(rest.substr(0, dot)));
      if (path_.back().empty())
        throw Error(ErrorKind::usage, "a part of the key is empty", "write --set beam.young=20e3",
                    where_);
      if (path_.size() > static_cast<std::size_t>(kMaxSceneDepth))
        throw Error(ErrorKind::usage, fmt::format("a key of more than {} parts", kMaxSceneDepth),
                    "docs/scene-format.md lists the keys of a scene", where_);
      if (dot == std::string_view::npos) break;
      rest.remove_prefix(dot + 1);
    }
  }

  void apply() {
    resolve_name();
    require_named(0);
    if (path_.size() > 2 && path_[0] == "body" && path_[2] == "region") require_named(2);
    DocValue* at = &root_;
    for (const std::string& part : path_) at = &step_into(*at, part);
    *at = value();
  }

 private:
  // Turns NAME.key into body.NAME.key, and likewise for the other named tables.
  void resolve_name() {
    const std::string& first = path_.front();
    if (path_.size() < 2 || key_tables().scene.find(first) != nullptr) return;
    std::vector<std::string> holders;
    std::vector<std::string> names;
    for (const std::string_view table : named_tables) {
      const DocValue* entries = root_.find(table);
      if (entries == nullptr) continue;
      if (entries->find(first) != nullptr) holders.emplace_back(table);
      for (const DocEntry& entry : entries->entries) names.push_back(entry.key);
    }
    if (holders.empty()) {
      for (const Key& key : key_tables().scene.keys) names.emplace_back(key.name);
      throw Error(
          ErrorKind::input,
          fmt::format("nothing in the scene is named '{}'{}", first, did_you_mean(first, names)),
          "a key begins with a table of the scene (output.fps) or with the name of a body, "
          "pin, attachment, distance, force, probe, obstacle or cut (beam.young)",
          where_);
    }
    if (holders.size() > 1 && holders.front() != "body")
      throw Error(ErrorKind::input,
                  fmt::format("'{}' names both a {} and a {}", first, holders[0], holders[1]),
                  fmt::format("write {}.{} or {}.{}", holders[0], first, holders[1], first),
                  where_);
    path_.insert(path_.begin(), holders.front());
  }

  // An override changes existing parts: path_[at + 1] must be an entry of the named table at the
  // path up to `at`.
  void require_named(std::size_t at) {
    if (path_.size() < at + 2 || (at == 0 && std::find(named_tables.begin(), named_tables.end(),
                                                       path_[0]) == named_tables.end()))
      return;
    const DocValue* table = &root_;
    for (std::size_t i = 0; i <= at && table != nullptr; ++i) table = table->find(path_[i]);
    const std::string& name = path_[at + 1];
    if (table != nullptr && table->find(name) != nullptr) return;
    std::vector<std::string> names;
    if (table != nullptr)
      for (const DocEntry& entry : table->entries) names.push_back(entry.key);
    throw Error(
        ErrorKind::input,
        fmt::format("the scene has no {} '{}'{}", path_[at], name, did_you_mean(name, names)),
        "--set changes what the scene file has", where_);
  }

  // The entry or item of that name; a missing entry is created.
  DocValue& step_into(DocValue& parent, const std::string& part) {
    if (parent.type == DocValue::Type::array) {
      std::size_t index = 0;
      const char* end = part.data() + part.size();
      const auto [stop, error] = std::from_chars(part.data(), end, index);
      if (error != std::errc() || stop != end || index >= parent.items.size())
        throw Error(
            ErrorKind::input,
            fmt::format("'{}' is not one of the array's {} items", part, parent.items.size()),
            "items count from 0", where_);
      return parent.items[index];
    }
    if (!parent.is_table())
      throw Error(ErrorKind::input,
                  fmt::format("'{}' would be within {}, which is no table", part, describe(parent)),
                  "docs/scene-format.md lists the keys of a scene", where_);
    if (DocValue* found = parent.find(part)) return *found;
    DocValue table;
    table.where = where_;
    parent.entries.push_back({part, table, where_});
    return parent.entries.back().value;
  }

  DocValue value() const {
    DocValue out;
    out.type = DocValue::Type::text;  // unless it is TOML
    out.text = value_text_;
    try {
      DocValue document = parse_document("value = " + value_text_, "");
      if (document.entries.size() == 1) out = std::move(document.entries[0].value);
    } catch (const Error&) {
      require_text(out);  // without quotes
    }
    place(out);
    return out;
  }

  // The scene's document contains it and must be readable.
  void require_text(const DocValue& value) const {
    DocValue document;
    document.entries.push_back({"value", value, where_});
    try {
      parse_document(write_document(document), "");
    } catch (const Error&) {
      throw Error(ErrorKind::input, "the value is no text: some of its bytes are not UTF-8",
                  "give numbers as 12.5, texts in UTF-8", where_);
    }
  }

  void place(DocValue& value) const {
    value.where = where_;
    for (DocValue& item : value.items) place(item);
    for (DocEntry& entry : value.entries) {
      entry.where = where_;
      place(entry.value);
    }
  }

  DocValue& root_;
  Location where_;
  std::string value_text_;
  KeyPath path_;
};

}  // namespace

void apply_overrides(DocValue& root, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) Override(root, text).apply();
}

}  // namespace sinew
