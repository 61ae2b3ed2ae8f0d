// The folder of a run: locked while it is written, and never at the cost of a file that Sinew did
// not write. docs/output.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

// What a run writes into its folder, in addition to run.lock.
struct RunFiles {
  std::string scene;               // its name: frames/SCENE_0000.vtu
  std::vector<std::string> names;  // of the files at the top of the folder
};

// The folder, locked from its construction to the end of the process or of the object. The lock is
// one of the system on the file run.lock, so it goes with the process, however that ends. run.lock
// also lists what Sinew wrote here.
class RunFolder {
 public:
  // Throws what make() throws for this folder, without a change to it. To be called before a long
  // preparation.
  static void require_free(const std::filesystem::path& folder, bool force);

  // Makes the folder, or takes one that is there, removes the files of an earlier run if `force`
  // allows it, and writes scene.toml. Files that Sinew did not write stay. Error(usage) if the
  // folder holds a run and not `force`, or files of other origin and not `force`; if a file of
  // other origin or one of `inputs`, which the run reads, is in the way; if another run is writing
  // there. Error(io) if the system refuses.
  static RunFolder make(const std::filesystem::path& folder, bool force, const RunFiles& files,
                        const std::vector<std::filesystem::path>& inputs,
                        std::string_view scene_toml);

  // Takes the folder of a run that goes on. Error(usage) if another run is writing there.
  static RunFolder open(const std::filesystem::path& folder);

  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

 private:
  explicit RunFolder(const std::filesystem::path& folder);
  void write_list(const RunFiles& files, const std::string& scene_hash) const;

  std::filesystem::path folder_;
  int lock_ = -1;  // file descriptor
};

}  // namespace sinew
