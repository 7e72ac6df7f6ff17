#pragma once

// The Fields that turn a table of the document into values, and report what does not fit.

#include "sim/scene_file/diagnostics.hpp"
#include "sim/scene_file/document.hpp"
#include "sim/scene_file/fields.hpp"

namespace unravel::sim {

/// Keeps what the tables of one scene share while it is read.
struct Reading {
    std::vector<SceneProblem>& problems;
    Places& places;
    std::map<std::string, std::vector<std::string>> tables_of_keys = {};  ///< made for the first unknown key
};

class Reader : public Fields {
public:
    /// `path` of the table; empty for the whole scene.
    Reader(const Node& table, std::string path, Reading& shared)
        : table_(table), path_(std::move(path)), shared_(shared) {}

    /// Reports required keys that are absent, and keys that no call asked for.
    void finish();

    bool reading() const override { return true; }
    bool says(std::string_view key) const override { return table_.find(key) != nullptr; }
    void problem(std::string_view key, std::string what, std::string hint) override;
    bool sound(std::string_view key) const override { return shared_.places.sound(path_of(key)); }
    void place(SourcePlace& place, std::string_view key) const override;
    void exactly_one(std::initializer_list<std::string_view> keys) override;

    void flag(const Key&, bool&) override;
    void integer(const Key&, int&, int low, int high) override;
    void integers(const Key&, std::span<int>, int low, int high) override;
    void seed(const Key&, std::uint32_t&) override;
    void number(const Key&, double&, const Bounds&) override;
    void optional_number(const Key&, std::optional<double>&, const Bounds&) override;
    void numbers(const Key&, std::span<double>, const Bounds&) override;
    void number_or_pair(const Key&, std::array<double, 2>&, const Bounds&) override;
    void fraction(const Key&, double&, const Bounds&) override;
    void rate(const Key&, Rate&, int low, int high) override;
    bool number_or_table(const Key&, double&, const Bounds&,
                         const std::function<void(Fields&)>& describe) override;
    void text(const Key&, std::string&, TextKind) override;
    void texts(const Key&, std::vector<std::string>&, TextKind) override;
    void word(const Key&, std::string&, std::span<const std::string_view> words) override;
    void words(const Key&, std::vector<std::string>&, std::span<const std::string_view> words) override;
    void table(const Key&, const std::function<void(Fields&)>& describe) override;

protected:
    bool creates(const Key&) override;
    void choose(const Key&, int& index, std::span<const std::string_view> words) override;
    void items(const Key&, std::size_t count, const std::function<void(std::size_t)>& resize,
               const std::function<void(Fields&, std::size_t)>& item, ListForm) override;

private:
    /// The key's value if it is there and may be; marks the key as known.
    const Node* take(const Key&);
    void know(std::string_view key);
    std::string path_of(std::string_view key) const;
    void report(std::string_view key, SourcePlace place, std::string what, std::string hint = {});
    bool wrong_kind(std::string_view key, const Node& value, std::string_view wanted);
    bool read_number(std::string_view key, const Node& value, const Bounds&, double& out);
    bool read_integer(std::string_view key, const Node& value, std::int64_t low, std::int64_t high,
                      std::int64_t& out);
    bool read_text(std::string_view key, const Node& value, TextKind, std::string& out);
    int read_word(std::string_view key, const Node& value, std::span<const std::string_view> words);
    void read_table(const std::string& path, const Node& value, const std::function<void(Fields&)>& describe);
    void report_unknown(const Entry&);

    const Node& table_;
    std::string path_;
    Reading& shared_;
    std::vector<std::string_view> known_;
};

}  // namespace unravel::sim
