// Outputs that are whole or absent: written beside the target under a temporary name, synced, renamed. The
// name is ".TARGET.HOST.PID.RANDOM.tmp".
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace levelray {

// Calls write(temporary_path), which must create that file and close it; then syncs it, renames it to `path`
// and syncs the folder. When anything fails, or write throws, the temporary file is removed and an older
// `path` is left as it was. Throws Error(cannot_write) naming `path` and the system's reason; what write
// throws passes through, with `path` in the place of the temporary name. A symbolic link is followed; an
// older file's permissions are kept. A device or pipe has no older content to protect: write(path) is called
// on it.
void write_file_atomically(const std::string& path,
                           const std::function<void(const std::string& temporary_path)>& write);

// The same with the file's whole content.
void write_file_atomically(const std::string& path, std::string_view content);

// Throws Error(cannot_write) when a file could not be created beside `path`: asked before long work.
void check_writable(const std::string& path);

// Removes what processes of this machine that are no more (kill -9) left of writing `path`. Done whenever a
// write begins; a folder's left-overs are those it has when this process first comes to it.
void remove_stale_temporary_files(const std::string& path);

// Removes the temporary files of running writes; async-signal-safe, for handlers of signals that end the
// program at once.
void remove_temporary_files() noexcept;

} // namespace levelray
