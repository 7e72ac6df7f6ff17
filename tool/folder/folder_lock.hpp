#pragma once

#include <filesystem>

#include "tool/base/names.hpp"

namespace unravel::tool {

/// Held while a run writes into a folder, so that a second one pointed there by mistake is told so instead of
/// mixing its files with the first's. The system lets go of it however the program ends. Where a file system
/// knows no locks there is none.
class FolderLock {
public:
    /// Makes the folder if it is missing. Throws FolderError if another process holds it, OutputError.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int descriptor_ = -1;
};

}  // namespace unravel::tool
