// Commands whose work is done by the Python package.
#pragma once

#include <string>
#include <vector>

// Becomes `python3 ARGUMENTS`, with the package beside this program, in a build folder or an
// installation, or else Python's own. Throws Error(usage) if no Python finds the package.
[[noreturn]] void become_python(std::vector<std::string> arguments);
