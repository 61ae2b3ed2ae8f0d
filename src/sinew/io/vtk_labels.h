// The arrays of a VTK file, and the choice of those that hold labels. For legacy VTK and VTU.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/io/mesh_notes.h"

namespace sinew::io {

// The arrays of the cells or of the points. The rule: the array that was asked for; otherwise the
// first name of a list that the field uses; otherwise the first array with an integer type whose
// name is not that of an id and which has at most most_labels different values. Arrays of text,
// vectors and fractions are passed over.
class LabelArrays {
 public:
  using Load = std::function<std::vector<double>()>;

  // of_cells: otherwise of points. asked: a name, or empty.
  LabelArrays(bool of_cells, std::string asked) : of_cells_(of_cells), asked_(std::move(asked)) {}

  // load returns the values; it is called only if the array may be the one.
  void add(std::string name, ArrayKind kind, Load load);
  // Whether an array of real numbers with this name may hold labels.
  bool wants(std::string_view name) const;

  // The labels, one for each of the count cells or points; empty: none. Lists the arrays in
  // `notes`. Error (input) if the array asked for is not there or holds no labels.
  std::vector<int> choose(std::size_t count, const std::string& file, ReadNotes& notes) const;

 private:
  struct Entry {
    std::string name;
    ArrayKind kind;
    Load load;
  };
  std::size_t asked_entry(const std::string& file) const;
  std::vector<std::size_t> candidates() const;
  const char* what() const { return of_cells_ ? "cell" : "point"; }
  void remark_others(std::size_t chosen, ReadNotes& notes) const;

  bool of_cells_;
  std::string asked_;
  std::vector<Entry> entries_;
};

}  // namespace sinew::io
