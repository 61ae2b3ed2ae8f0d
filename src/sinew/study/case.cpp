#include "sinew/study/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "sinew/io/file_io.h"
#include "sinew/scene/document.h"
#include "sinew/scene/keys.h"
#include "sinew/scene/laws.h"

namespace sinew::study {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<const char*, Kind>, 14> kinds = {{
    {"probe", Kind::probe},
    {"radial", Kind::radial},
    {"stretch", Kind::stretch},
    {"force", Kind::force},
    {"torque", Kind::torque},
    {"stress", Kind::stress},
    {"patch", Kind::patch},
    {"frequency", Kind::frequency},
    {"volume", Kind::volume},
    {"lowest", Kind::lowest},
    {"contact_time", Kind::contact_time},
    {"sink", Kind::sink},
    {"leave", Kind::leave},
    {"obstacle", Kind::obstacle},
}};

constexpr const char* where_documented = "docs/validation.md lists the keys of a case";

// A table whose keys are all known.
class CaseTable {
 public:
  CaseTable(const DocValue& value, std::string name, const std::vector<std::string>& known)
      : value_(value), name_(std::move(name)) {
    if (!value.is_table()) fail(value, "is not a table");
    for (const DocEntry& entry : value.entries) {
      if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
      throw Error(
          ErrorKind::input,
          fmt::format("unknown key '{}' in {}{}", entry.key, name_, did_you_mean(entry.key, known)),
          where_documented, entry.where);
    }
  }

  std::string text(const char* key, bool needed = false) const {
    const DocValue* v = find(key, needed);
    if (v == nullptr) return {};
    if (v->type != DocValue::Type::text) fail(*v, fmt::format("'{}' is not a text", key));
    return v->text;
  }

  double number(const char* key, bool needed = false) const {
    const DocValue* v = find(key, needed);
    return v == nullptr ? 0.0 : number_of(*v, key);
  }

  bool boolean(const char* key) const {
    const DocValue* v = find(key, false);
    if (v == nullptr) return false;
    if (v->type != DocValue::Type::boolean) fail(*v, fmt::format("'{}' is not true or false", key));
    return v->boolean;
  }

  std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> out;
    for (const DocValue& item : items(key)) {
      if (item.type != DocValue::Type::text) fail(item, fmt::format("'{}' holds no text", key));
      out.push_back(item.text);
    }
    return out;
  }

  std::vector<double> numbers(const char* key) const {
    std::vector<double> out;
    for (const DocValue& item : items(key)) out.push_back(number_of(item, key));
    return out;
  }

  const std::vector<DocValue>& items(const char* key) const {
    static const std::vector<DocValue> none;
    const DocValue* v = find(key, false);
    if (v == nullptr) return none;
    if (v->type != DocValue::Type::array) fail(*v, fmt::format("'{}' is not an array", key));
    return v->items;
  }

  [[noreturn]] void fail(const DocValue& at, const std::string& what) const {
    throw Error(ErrorKind::input, fmt::format("{}: {}", name_, what), where_documented, at.where);
  }

 private:
  const DocValue* find(const char* key, bool needed) const {
    const DocValue* v = value_.find(key);
    if (v == nullptr && needed) fail(value_, fmt::format("the key '{}' is missing", key));
    return v;
  }
  double number_of(const DocValue& v, const char* key) const {
    if (v.type == DocValue::Type::integer) return static_cast<double>(v.integer);
    if (v.type != DocValue::Type::number) fail(v, fmt::format("'{}' is not a number", key));
    return v.number;
  }

  const DocValue& value_;
  std::string name_;
};

std::vector<Choice> read_choices(const CaseTable& root, const char* key) {
  std::vector<Choice> out;
  for (const DocValue& item : root.items(key)) {
    const CaseTable t(item, fmt::format("[[{}]]", key), {"name", "set", "full", "limit"});
    out.push_back(
        {t.text("name", true), t.texts("set"), t.boolean("full"), t.numbers("limit"), item.where});
    for (std::size_t i = 0; i + 1 < out.size(); ++i)
      if (out[i].name == out.back().name)
        t.fail(item, fmt::format("there are two of the name '{}'", out.back().name));
  }
  if (out.empty()) out.push_back({});
  return out;
}

Quantity read_quantity(const DocValue& item) {
  const CaseTable t(item, "[[quantity]]",
                    {"name", "kind", "of", "axis", "mode", "unit", "scale", "limit"});
  Quantity q;
  q.name = t.text("name", true);
  const std::string kind = t.text("kind", true);
  std::vector<std::string> known;
  bool found = false;
  for (const auto& [word, value] : kinds) {
    known.emplace_back(word);
    if (kind != word) continue;
    q.kind = value;
    found = true;
  }
  if (!found)
    t.fail(*item.find("kind"), fmt::format("unknown kind '{}'{}", kind, did_you_mean(kind, known)));
  q.of = t.text("of");
  q.axis = t.text("axis");
  q.mode = static_cast<int>(std::clamp(t.number("mode"), 0.0, 100.0));
  q.unit = t.text("unit");
  q.scale = t.number("scale");
  q.limit = t.numbers("limit");
  q.where = item.where;
  const std::vector<Kind> whole = {Kind::stress, Kind::frequency, Kind::volume, Kind::contact_time};
  const bool needs_of = std::find(whole.begin(), whole.end(), q.kind) == whole.end();
  if (needs_of && q.of.empty()) t.fail(item, "'of' is missing: what is measured?");
  const bool free_axis = q.kind == Kind::radial || q.kind == Kind::patch ||
                         q.kind == Kind::frequency || q.kind == Kind::volume ||
                         q.kind == Kind::contact_time;
  const std::size_t letters = q.kind == Kind::stress ? 2 : 1;
  if (q.axis.find_first_not_of("xyz") != std::string::npos ||
      (q.axis.size() != letters && !(free_axis && q.axis.empty())))
    t.fail(item,
           fmt::format("'axis' of '{}' is '{}'; expected {} of x, y, z", q.name, q.axis, letters));
  if (q.kind == Kind::frequency && q.mode < 1) t.fail(item, "'mode' is missing: the number from 1");
  return q;
}

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

void check_known(const std::string& name, const std::vector<std::string>& known, const char* what,
                 const Location& where) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw Error(ErrorKind::input,
              fmt::format("case.toml has no {} '{}'{}", what, name, did_you_mean(name, known)),
              "a reference names a variant and a quantity of its case", where);
}

void read_references(Case& c) {
  const fs::path file = c.folder / "reference.toml";
  std::error_code failed;
  if (!fs::exists(file, failed))
    throw Error(ErrorKind::input, fmt::format("the case '{}' has no reference values", c.name),
                "reference.toml has to be there; docs/validation.md says what it holds",
                {file.string()});
  const DocValue document = parse_document(io::read_file(file), file.string());
  const CaseTable root(document, "reference.toml", {"source", "value"});
  c.source = root.text("source");
  for (const DocValue& item : root.items("value")) {
    const CaseTable t(item, "[[value]]", {"variant", "quantity", "value", "error"});
    Reference r{t.text("variant"), t.text("quantity", true), t.number("value", true),
                t.number("error")};
    check_known(r.variant, names_of(c.variants), "variant", item.where);
    check_known(r.quantity, names_of(c.quantities), "quantity", item.where);
    c.references.push_back(std::move(r));
  }
  for (const Quantity& q : c.quantities) {
    const bool any = std::any_of(c.references.begin(), c.references.end(),
                                 [&](const Reference& r) { return r.quantity == q.name; });
    if (!any)
      throw Error(ErrorKind::input,
                  fmt::format("no reference value for the quantity '{}' of case.toml", q.name),
                  "add a [[value]] with it, or remove the quantity", {file.string()});
  }
}

}  // namespace

const Reference* Case::reference(const std::string& variant, const std::string& quantity) const {
  for (const Reference& r : references)
    if (r.variant == variant && r.quantity == quantity) return &r;
  return nullptr;
}

std::optional<double> limit_of(const Quantity& quantity, const Choice& variant, std::size_t mesh) {
  const std::vector<double>& limit = variant.limit.empty() ? quantity.limit : variant.limit;
  if (limit.empty() || quantity.limit.empty()) return std::nullopt;
  return limit[std::min(mesh, limit.size() - 1)];
}

std::vector<std::string> case_names(const fs::path& folder) {
  std::error_code failed;
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
    if (fs::exists(entry.path() / "case.toml", failed))
      names.push_back(entry.path().filename().string());
  if (!fs::is_directory(folder, failed))
    throw Error(ErrorKind::io, "there is no such folder of cases",
                "run in Sinew's folder, or name its folder validation with --dir",
                {folder.string()});
  if (names.empty())
    throw Error(ErrorKind::input, "the folder has no case: no case.toml one level down",
                "name Sinew's folder validation with --dir", {folder.string()});
  std::sort(names.begin(), names.end());
  return names;
}

Case load_case(const fs::path& folder, const std::string& name) {
  const std::vector<std::string> known = case_names(folder);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    std::string list;
    for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
    throw Error(ErrorKind::usage,
                fmt::format("there is no case '{}'{}", name, did_you_mean(name, known)),
                "the cases are: " + list);
  }
  Case c;
  c.name = name;
  c.folder = folder / name;
  const fs::path file = c.folder / "case.toml";
  const DocValue document = parse_document(io::read_file(file), file.string());
  const CaseTable root(document, "case.toml", {"title", "laws", "variant", "mesh", "quantity"});
  c.title = root.text("title", true);
  c.laws = root.texts("laws");
  for (const std::string& law : c.laws) {
    if (find_law(law) == nullptr)
      root.fail(*document.find("laws"),
                fmt::format("unknown law '{}'{}", law, did_you_mean(law, law_choice_names())));
  }
  if (c.laws.empty()) c.laws = law_choice_names();
  c.variants = read_choices(root, "variant");
  c.meshes = read_choices(root, "mesh");
  for (const DocValue& item : root.items("quantity")) c.quantities.push_back(read_quantity(item));
  if (c.quantities.empty()) root.fail(document, "no [[quantity]]: nothing would be measured");
  read_references(c);
  return c;
}

}  // namespace sinew::study
