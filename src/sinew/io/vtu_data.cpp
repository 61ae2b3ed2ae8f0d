#include "sinew/io/vtu_data.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <vector>

#include "sinew/io/base64.h"
#include "sinew/io/text_reader.h"
#include "sinew/io/value_reader.h"

namespace sinew::io {
namespace {

// Maximum expansion of a byte by zlib (its manual: 1032), with a margin for small blocks.
constexpr std::size_t most_expansion = 1040;
constexpr std::size_t expansion_room = 64;

// The bytes of the text one after the other, through Base64 or as they are.
class ByteSource {
 public:
  ByteSource(std::string_view text, bool is_raw) : text_(text), is_raw_(is_raw), base64_(text) {}

  // Replaces bytes by the next `count`.
  bool read(std::size_t count, std::string& bytes) {
    bytes.clear();
    if (count > remaining()) return false;
    if (!is_raw_) return base64_.read(count, bytes);
    bytes = text_.substr(at_, count);
    at_ += count;
    return true;
  }
  std::size_t remaining() const { return is_raw_ ? text_.size() - at_ : base64_.remaining(); }
  std::string problem() const {
    if (const auto bad = base64_.bad_at()) {
      return fmt::format("is not Base64: character {} is {}", *bad + 1,
                         quoted(text_.substr(*bad, 1)));
    }
    return "ends before its data are complete";
  }

 private:
  std::string_view text_;
  bool is_raw_;
  std::size_t at_ = 0;
  Base64Reader base64_;
};

class Decoder {
 public:
  Decoder(ByteSource& source, const VtuForm& form, std::size_t most, std::string& problem)
      : source_(source), form_(form), most_(most), problem_(problem) {}

  bool plain(std::string& bytes) {
    std::vector<std::uint64_t> size;
    if (!header(1, size) || !fits(size[0])) return false;
    return source_.read(size[0], bytes) || fail(source_.problem());
  }

  bool compressed(std::string& bytes) {
    std::vector<std::uint64_t> head;  // blocks, size of each, size of the last (0: full)
    if (!header(3, head)) return false;
    const std::uint64_t blocks = head[0];
    if (blocks > source_.remaining() / form_.header_bytes) {
      return fail(fmt::format("says it has {} blocks, more than its text can hold", blocks));
    }
    std::vector<std::uint64_t> sizes;
    if (!header(blocks, sizes)) return false;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const bool is_short = i + 1 == blocks && head[2] != 0;
      if (!block(i, sizes[i], is_short ? head[2] : head[1], bytes)) return false;
    }
    return true;
  }

 private:
  bool fail(std::string what) {
    problem_ = std::move(what);
    return false;
  }

  bool fits(std::uint64_t size) {
    return size <= most_ ||
           fail(fmt::format("says it has {} bytes; at most {} were expected", size, most_));
  }

  bool header(std::uint64_t count, std::vector<std::uint64_t>& numbers) {
    std::string bytes;
    if (!source_.read(count * form_.header_bytes, bytes)) return fail(source_.problem());
    for (std::uint64_t i = 0; i < count; ++i) {
      const char* at = bytes.data() + i * form_.header_bytes;
      numbers.push_back(form_.header_bytes == 4 ? from_bytes<std::uint32_t>(at, form_.swap)
                                                : from_bytes<std::uint64_t>(at, form_.swap));
    }
    return true;
  }

  bool block(std::uint64_t number, std::uint64_t packed_size, std::uint64_t size,
             std::string& bytes) {
    std::string packed;
    if (!source_.read(packed_size, packed)) return fail(source_.problem());
    if (size > most_expansion * packed_size + expansion_room) {
      return fail(fmt::format("says that block {} grows from {} to {} bytes, which zlib cannot",
                              number, packed_size, size));
    }
    const std::size_t before = bytes.size();
    if (!fits(before + size)) return false;
    bytes.resize(before + size);
    uLongf length = size;
    const int code = uncompress(reinterpret_cast<Bytef*>(bytes.data() + before), &length,
                                reinterpret_cast<const Bytef*>(packed.data()), packed_size);
    if (code == Z_OK && length == size) return true;
    return fail(fmt::format("has a damaged zlib block {}: {}", number,
                            code == Z_OK ? "it is shorter than its header says"
                            : code == Z_BUF_ERROR
                                ? "it is longer than its header says, or cut short"
                                : "the compressed data are not valid"));
  }

  ByteSource& source_;
  const VtuForm& form_;
  std::size_t most_;
  std::string& problem_;
};

}  // namespace

bool decode_vtu_array(std::string_view text, bool is_raw, const VtuForm& form, std::size_t most,
                      std::string& bytes, std::string& problem) {
  ByteSource source(text, is_raw);
  Decoder decoder(source, form, most, problem);
  return form.zlib ? decoder.compressed(bytes) : decoder.plain(bytes);
}

}  // namespace sinew::io
