// Values given on the command line: --set a.b.c=value.
#pragma once

#include <string>
#include <vector>

#include "sinew/scene/document.h"

namespace sinew {

// Writes each "path=value" into the document, in order.
//
// The path is that of the file (body.beam.young, output.fps, pin.end.path.1.time); where it begins
// with the name of a body, or of one pin, attachment, force or probe, it goes there (beam.young).
// The value is TOML; what is not TOML is taken as text, so that law=lloyd needs no quotes.
//
// Error(usage) where there is no '=' or no path; Error(input) where nothing has that name. Keys and
// values are checked later with those of the file; their place is "--set path=value".
void apply_overrides(DocValue& root, const std::vector<std::string>& overrides);

}  // namespace sinew
