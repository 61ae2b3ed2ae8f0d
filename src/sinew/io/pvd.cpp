#include "sinew/io/pvd.h"

#include <fmt/format.h>

#include <iterator>

#include "sinew/io/file_io.h"
#include "sinew/io/xml_text.h"

namespace sinew::io {

std::string format_pvd(std::span<const PvdEntry> entries) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n";
  text += "<Collection>\n";
  for (const PvdEntry& entry : entries) {
    fmt::format_to(std::back_inserter(text), "<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n",
                   entry.time, xml_escaped(entry.file));
  }
  text += "</Collection>\n</VTKFile>\n";
  return text;
}

void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries) {
  write_file(path, format_pvd(entries));
}

}  // namespace sinew::io
