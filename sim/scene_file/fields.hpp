#pragma once

// How a table of the scene file is described once and used three times: by the reader (TOML to values), the
// writer (values to TOML) and the schema (values to JSON schema), so that the three can't disagree.
// describe.hpp has one function per table; each calls these members in the order in which keys are written.

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/scene/enums.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// A key of a table.
struct Key {
    std::string_view name;
    std::string_view doc;   ///< for the schema: unit and meaning
    bool required = false;  ///< its absence is a problem
    bool applies = true;    ///< false: refused when read ("a box has no radius"), not written
};

/// What a number may be. Not-a-number and infinities are always refused.
struct Bounds {
    double low = 0, high = 0;
    bool above_low = false;  ///< low itself is refused
    std::string_view unit = {};
};

enum class TextKind {
    name,   ///< 1 to 64 characters, none of them control characters
    color,  ///< "#rrggbb"
    path    ///< relative to the scene's folder
};

enum class ListForm { tables, inline_tables };

class Fields {
public:
    virtual ~Fields() = default;

    virtual bool reading() const { return false; }
    virtual bool writing() const { return false; }
    /// Reader: whether the table has this key. Elsewhere false.
    virtual bool says(std::string_view /*key*/) const { return false; }
    /// Reader: a problem with the key's value that only the table's own description can see.
    virtual void problem(std::string_view /*key*/, std::string /*what*/, std::string /*hint*/) {}
    /// Reader: whether the key's value had no problem so far (also if it is absent).
    virtual bool sound(std::string_view /*key*/) const { return false; }
    /// Reader: where the key's value stands; without such a key, where the table begins.
    virtual void place(SourcePlace& /*place*/, std::string_view /*key*/ = {}) const {}
    /// The table has to have exactly one of these keys.
    virtual void exactly_one(std::initializer_list<std::string_view> /*keys*/) {}

    virtual void flag(const Key&, bool&) = 0;
    virtual void integer(const Key&, int&, int low, int high) = 0;
    /// A whole number, or a text "a/b" of two whole numbers; low and high bound the quotient.
    virtual void rate(const Key&, Rate&, int low, int high) = 0;
    virtual void integers(const Key&, std::span<int>, int low, int high) = 0;
    virtual void seed(const Key&, std::uint32_t&) = 0;
    virtual void number(const Key&, double&, const Bounds&) = 0;
    virtual void optional_number(const Key&, std::optional<double>&, const Bounds&) = 0;
    virtual void numbers(const Key&, std::span<double>, const Bounds&) = 0;
    /// One number for both, or a list of two.
    virtual void number_or_pair(const Key&, std::array<double, 2>&, const Bounds&) = 0;
    /// A number, or a text "a/b" of two whole numbers.
    virtual void fraction(const Key&, double&, const Bounds&) = 0;
    /// A plain number (true is returned), or a table.
    virtual bool number_or_table(const Key&, double&, const Bounds&,
                                 const std::function<void(Fields&)>& describe) = 0;
    virtual void text(const Key&, std::string&, TextKind) = 0;
    /// A text or a list of them.
    virtual void texts(const Key&, std::vector<std::string>&, TextKind) = 0;
    /// One of some words, kept as text; empty where absent.
    virtual void word(const Key&, std::string&, std::span<const std::string_view> words) = 0;
    /// One of some words or a list of them.
    virtual void words(const Key&, std::vector<std::string>&, std::span<const std::string_view> words) = 0;

    /// A nested table, left as it is where absent.
    virtual void table(const Key&, const std::function<void(Fields&)>& describe) = 0;

    template <class Enum>
    void choice(const Key& key, Enum& value) {
        int index = static_cast<int>(value);
        choose(key, index, words_of(value));
        value = static_cast<Enum>(index);
    }

    /// A table whose absence means that the scene does not call for it.
    template <class T, class Describe>
    void optional_table(const Key& key, std::optional<T>& value, const T& initial, Describe&& describe) {
        if (creates(key)) value = initial;
        if (value) table(key, [&](Fields& nested) { describe(nested, *value); });
    }

    /// A list of tables; a single table stands for a list of one.
    template <class T, class Describe>
    void list(const Key& key, std::vector<T>& values, ListForm layout, Describe&& describe) {
        items(
            key, values.size(), [&](std::size_t count) { values.resize(count); },
            [&](Fields& nested, std::size_t i) { describe(nested, values[i]); }, layout);
    }

    void vector(const Key& key, Vec3& value, const Bounds& bounds) {
        numbers(key, std::span<double>(value.data(), 3), bounds);
    }

protected:
    /// Whether an optional table of this name comes to be: it is in the file (reader), always (schema).
    virtual bool creates(const Key&) = 0;
    virtual void choose(const Key&, int& index, std::span<const std::string_view> words) = 0;
    virtual void items(const Key&, std::size_t count, const std::function<void(std::size_t)>& resize,
                       const std::function<void(Fields&, std::size_t)>& item, ListForm) = 0;
};

}  // namespace unravel::sim
