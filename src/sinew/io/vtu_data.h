// Decodes the arrays of a VTU file, in any of their forms. For vtu_read.cpp only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace sinew::io {

// The storage form of a file's binary arrays, from the attributes of VTKFile.
struct VtuForm {
  bool swap = false;             // the opposite byte order of this machine
  std::size_t header_bytes = 4;  // of the numbers before an array: UInt32 or UInt64
  bool zlib = false;
};

// Decodes one array, plain or compressed. `text` is Base64 (is_raw: bytes) that starts with the
// array's header; text after the array is ignored. On failure returns false and sets `problem` to
// the fault. More bytes than `most` are refused before they are decoded.
bool decode_vtu_array(std::string_view text, bool is_raw, const VtuForm& form, std::size_t most,
                      std::string& bytes, std::string& problem);

}  // namespace sinew::io
