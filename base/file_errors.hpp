#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace unravel {

/// A file that could not be written. what(): "can't write FILE: REASON", with what to do where that is known.
/// code() is the system's error number.
class OutputError : public std::system_error {
public:
    OutputError(std::filesystem::path file, int error_number);
    /// For failures that no error number tells.
    OutputError(std::filesystem::path file, const std::string& reason);

    const char* what() const noexcept override { return text_.c_str(); }
    const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
    std::string text_;
};

/// A file that could not be read or whose content is not what it should be. what(): "can't read FILE:
/// REASON".
class InputError : public std::runtime_error {
public:
    InputError(std::filesystem::path file, const std::string& reason);

    const std::filesystem::path& file() const { return file_; }

private:
    std::filesystem::path file_;
};

}  // namespace unravel
