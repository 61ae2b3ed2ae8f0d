// Values given on the command line: --set a.b.c=value.
#pragma once

#include <string>
#include <vector>

#include "sinew/scene/document.h"

namespace sinew {

// Writes each "path=value" into the document, in order.
//
// The path is that of the file (body.beam.young, output.fps, pin.end.path.1.time), or starts with
// the name of a body, or with the unique name of a pin, attachment, force or probe (beam.young).
// The value is TOML; anything else is taken as text, so law=lloyd needs no quotes.
//
// Error(usage) if there is no '=' or no path; Error(input) if nothing has that name. Keys and
// values are validated later with those of the file; their place is "--set path=value".
void apply_overrides(DocValue& root, const std::vector<std::string>& overrides);

}  // namespace sinew
