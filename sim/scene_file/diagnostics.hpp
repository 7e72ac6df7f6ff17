#pragma once

// Problems of a scene, gathered while reading and checking, and the text that shows them.

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene_file/load.hpp"

namespace unravel::sim {

/// A file that a scene includes.
struct IncludedFile {
    std::string name;  ///< as shown
    std::string text;
};

/// What the places of problems refer to.
struct Sources {
    std::string name;                      ///< of the file, as shown
    std::string_view text;                 ///< of the file
    std::span<const std::string> options;  ///< --set, the first is option 1
    std::vector<IncludedFile> included;    ///< the first is file 1
};

/// `file:line:column: error: what; hint`, the line and a caret, for each problem, options after the file.
std::string format_problems(std::vector<SceneProblem> problems, const Sources&);

/// The text with control characters replaced, so that a scene can't steer the terminal.
std::string printable(std::string_view text);

/// Where each value stands, by its path ("cloth[0].pin[1].release"), and which of them had a problem.
class Places {
public:
    void add(const std::string& path, SourcePlace place) { places_[path] = place; }
    /// Gives what stands under one path, "solid[0]", the same places under another.
    void repeat(const std::string& from, const std::string& to);
    bool has(const std::string& path) const { return places_.contains(path); }
    void mark_bad(const std::string& path) { bad_.insert(path); }
    /// The value's place, or that of the nearest table around it that the file has.
    SourcePlace at(std::string path) const;
    /// True if neither the value nor anything in it had a problem: what is derived from it can be checked.
    bool sound(const std::string& path) const;
    /// The same of a table's own values, whatever is in the tables in it.
    bool sound_itself(const std::string& table) const;

private:
    std::map<std::string, SourcePlace> places_;
    std::set<std::string> bad_;
};

}  // namespace unravel::sim
