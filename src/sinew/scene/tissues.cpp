#include "sinew/scene/tissues.h"

#include <fmt/format.h>

#include <algorithm>

#include "sinew/base/error.h"
#include "sinew/scene/document.h"
#include "sinew/scene/keys.h"

namespace sinew {

// The text of data/tissues.toml; sinew_embed in cmake/SinewRooms.cmake makes it.
extern const char tissues_toml[];

namespace {

using Type = DocValue::Type;

// The file belongs to Sinew, not to the user: a fault in it is a fault of Sinew, and a test reads
// it.
[[noreturn]] void refuse(const std::string& what, const Location& where) {
  throw Error(ErrorKind::internal, what, {}, where);
}

const DocValue& value_of(const DocValue& table, std::string_view key, Type type) {
  const DocValue* value = table.find(key);
  if (value == nullptr || value->type != type)
    refuse(fmt::format("no usable '{}'", key), table.where);
  return *value;
}

const std::string& text(const DocValue& table, std::string_view key) {
  return value_of(table, key, Type::text).text;
}

double number(const DocValue& value) {
  if (value.type == Type::integer) return static_cast<double>(value.integer);
  if (value.type != Type::number) refuse("no number", value.where);
  return value.number;
}

double number(const DocValue& table, std::string_view key) {
  const DocValue* value = table.find(key);
  if (value == nullptr) refuse(fmt::format("no '{}'", key), table.where);
  return number(*value);
}

TissueSource read_source(const DocValue& entry, const DocValue& publications) {
  const DocValue& p = value_of(publications, text(entry, "ref"), Type::table);
  TissueSource source;
  source.authors = text(p, "authors");
  source.year = static_cast<int>(value_of(p, "year", Type::integer).integer);
  source.title = text(p, "title");
  source.journal = text(p, "journal");
  if (p.find("doi") != nullptr) source.doi = text(p, "doi");
  source.says = text(entry, "says");
  return source;
}

Tissue read_tissue(const DocEntry& entry, const DocValue& publications) {
  const DocValue& t = entry.value;
  Tissue tissue;
  tissue.name = entry.key;
  tissue.title = text(t, "title");
  tissue.young = number(t, "young");
  const DocValue& range = value_of(t, "range", Type::array);
  if (range.items.size() != 2) refuse("a range has two ends", range.where);
  tissue.young_lowest = number(range.items[0]);
  tissue.young_highest = number(range.items[1]);
  tissue.poisson = number(t, "poisson");
  tissue.density = number(t, "density");
  if (t.find("loss_factor") != nullptr) tissue.loss_factor = number(t, "loss_factor");
  tissue.conditions = text(t, "conditions");
  for (const DocValue& source : value_of(t, "sources", Type::array).items)
    tissue.sources.push_back(read_source(source, publications));
  return tissue;
}

std::vector<Tissue> read_tissues() {
  const DocValue document = parse_document(tissues_toml, "data/tissues.toml");
  const DocValue& publications = value_of(document, "source", Type::table);
  std::vector<Tissue> all;
  for (const DocEntry& entry : value_of(document, "tissue", Type::table).entries)
    all.push_back(read_tissue(entry, publications));
  std::sort(all.begin(), all.end(),
            [](const Tissue& a, const Tissue& b) { return a.name < b.name; });
  return all;
}

}  // namespace

const std::vector<Tissue>& tissues() {
  static const std::vector<Tissue> all = read_tissues();
  return all;
}

const Tissue* find_tissue(std::string_view name) {
  for (const Tissue& tissue : tissues())
    if (tissue.name == name) return &tissue;
  return nullptr;
}

std::string unknown_tissue_message(std::string_view name) {
  std::vector<std::string> names;
  for (const Tissue& tissue : tissues()) names.push_back(tissue.name);
  return fmt::format("there is no material '{}'{}", name.substr(0, 64), did_you_mean(name, names));
}

std::string tissue_names() {
  std::string list;
  for (const Tissue& tissue : tissues()) list += (list.empty() ? "" : ", ") + tissue.name;
  return list;
}

void apply(const Tissue& tissue, Material& material) {
  material.young = tissue.young;
  material.poisson = tissue.poisson;
  material.density = tissue.density;
}

}  // namespace sinew
