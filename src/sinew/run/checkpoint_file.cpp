#include "sinew/run/checkpoint_file.h"

#include <cstring>
#include <string_view>

#include "sinew/base/error.h"
#include "sinew/base/hash.h"
#include "sinew/io/file_io.h"
#include "sinew/sim/checkpoint.h"

namespace sinew {
namespace {

constexpr std::string_view magic = "SINEWRN1";

std::uint64_t digest_of(std::string_view text) {
  Hash hash;
  hash.text(text);
  return hash.digest();
}

void put(std::string& out, std::uint64_t value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::uint64_t take(std::string_view& bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

[[noreturn]] void reject(const std::filesystem::path& file, const char* why) {
  throw Error(ErrorKind::input, why, "start the run again", Location{file.string()});
}

}  // namespace

void write_run_checkpoint(const std::filesystem::path& file, const std::string& document,
                          std::uint64_t model_hash, const RunState& run) {
  std::string bytes(magic);
  put(bytes, document.size());
  put(bytes, digest_of(document));
  bytes += document;
  bytes += encode_run(model_hash, run);
  io::write_durably(file, bytes);
}

RunCheckpoint read_run_checkpoint(const std::filesystem::path& file) {
  const std::string all = io::read_file(file);
  std::string_view bytes = all;
  constexpr std::size_t head = magic.size() + 2 * sizeof(std::uint64_t);
  if (bytes.size() < head || !bytes.starts_with(magic))
    reject(file, "not a checkpoint of this version of Sinew");
  bytes.remove_prefix(magic.size());
  const std::uint64_t size = take(bytes);
  const std::uint64_t digest = take(bytes);
  if (size > bytes.size() || digest_of(bytes.substr(0, size)) != digest)
    reject(file, "the checkpoint is damaged");
  return {std::string(bytes.substr(0, size)), std::string(bytes.substr(size))};
}

RunState state_of(const RunCheckpoint& checkpoint, const std::filesystem::path& file,
                  const Model& model) {
  return decode_run(checkpoint.state, file.string(), model.hash(), model.rest_position.size());
}

}  // namespace sinew
