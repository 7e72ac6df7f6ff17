#pragma once

#include <span>
#include <string>

#include "tool/export/export.hpp"

namespace unravel::tool {

/// A format that geometry is exported in. A new one is a file with what writes it, declared in export.hpp,
/// and its line in formats.cpp.
struct ExportFormat {
    const char* word;  ///< for --format
    /// `name`: of the run, for formats that put it into a file's name.
    Written (*write)(const ExportSource& source, const std::filesystem::path& folder,
                     const std::string& name);
};

std::span<const ExportFormat> export_formats();

}  // namespace unravel::tool
