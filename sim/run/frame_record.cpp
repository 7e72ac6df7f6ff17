#include "sim/run/frame_record.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "base/file_errors.hpp"
#include "base/hash.hpp"
#include "base/whole_file.hpp"

namespace unravel::sim {

namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");

// Far above what four million particles need; a damaged length must not become an allocation.
constexpr std::size_t largest_file = std::size_t{4} << 30;

// The one list of what a record holds. `archive` writes each member, or reads it in the same order.
template <typename Archive, typename Record>
void members(Archive& archive, Record& r) {
    archive(r.frame);
    archive(r.state.step);
    archive(r.state.t);
    archive(r.state.h_previous);
    archive(r.state.halvings);
    archive(r.state.whole_steps);
    archive(r.state.part);
    archive(r.state.strain);
    archive(r.state.x);
    archive(r.state.v);
    archive(r.state.dv);
    archive(r.state.x_previous);
    archive(r.state.v_previous);
    archive.list(r.state.contacts, [&](auto& c) {
        archive(c.particle);
        archive(c.solid);
        archive(c.held);
        archive(c.begins);
        archive(c.sliding);
        archive(c.force);
        archive(c.slip);
    });
    archive(r.energy);
    archive(r.energy_limit);
    archive(r.component);
    archive(r.free);
    archive(r.springs);
    archive.list(r.solves, [&](auto& c) {
        archive(c.iterations);
        archive(c.rvm);
        archive(c.residual);
        archive(c.converged);
        archive(c.by);
        archive(c.because);
    });
    archive.list(r.reports, [&](auto& s) {
        archive(s.step);
        archive(s.t);
        archive(s.h);
        archive(s.components);
        archive(s.largest);
        archive(s.constrained);
        archive(s.partly);
        archive(s.implicit);
        archive(s.explicit_);
        archive(s.inactive);
        archive(s.cg_iterations);
        archive(s.cg_iterations_max);
        archive(s.rvm);
        archive(s.rvm_whole);
        archive(s.whole_difference);
        archive(s.converged);
        archive(s.substeps);
        archive(s.rejected);
        archive(s.contacts);
        archive(s.self_contacts);
        archive(s.self_distance);
        archive(s.crossings);
        archive(s.in_solids);
        archive(s.deepest);
        archive(s.air_held);
        archive(s.strained);
        archive(s.pulling);
        archive(s.max_strain);
        archive(s.p99_strain);
        archive(s.lowest);
        archive(s.kinetic);
        archive(s.potential);
    });
}

class RecordWriter {
public:
    template <typename T>
    void operator()(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(&value, sizeof value);
    }
    void operator()(const Vec3& value) { append(value.data(), 3 * sizeof(double)); }
    void operator()(const std::optional<std::uint64_t>& value) {
        (*this)(value.has_value());
        (*this)(value.value_or(0));
    }
    template <typename T>
    void operator()(const std::vector<T>& values) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        append(values.data(), values.size() * sizeof(T));
    }
    template <typename T, typename F>
    void list(const std::vector<T>& values, const F& each) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        for (const T& value : values) each(value);
    }
    void append(const void* data, std::size_t size) {
        if (size == 0) return;
        const std::size_t at = bytes_.size();
        bytes_.resize(at + size);
        std::memcpy(bytes_.data() + at, data, size);
    }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

private:
    std::vector<std::uint8_t> bytes_;
};

class RecordReader {
public:
    RecordReader(const std::filesystem::path& file, const std::uint8_t* data, std::size_t size)
        : file_(file), data_(data), left_(size) {}

    template <typename T>
    void operator()(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        take(&value, sizeof value);
    }
    // A byte other than 0 or 1 is no bool, and reading it as one would be undefined.
    void operator()(bool& value) {
        std::uint8_t byte = 0;
        take(&byte, 1);
        value = byte != 0;
    }
    void operator()(Vec3& value) { take(value.data(), 3 * sizeof(double)); }
    void operator()(std::optional<std::uint64_t>& value) {
        bool present = false;
        std::uint64_t content = 0;
        (*this)(present);
        (*this)(content);
        value = present ? std::optional(content) : std::nullopt;
    }
    template <typename T>
    void operator()(std::vector<T>& values) {
        values.resize(length(sizeof(T)));
        take(values.data(), values.size() * sizeof(T));
    }
    template <typename T, typename F>
    void list(std::vector<T>& values, const F& each) {
        // One at a time: a length that lies ends with the bytes, before it has become memory.
        const std::size_t count = length(1);
        values.clear();
        for (std::size_t k = 0; k < count; ++k) each(values.emplace_back());
    }
    std::size_t left() const { return left_; }

private:
    std::size_t length(std::size_t item) {
        std::uint64_t count = 0;
        (*this)(count);
        if (count > left_ / item) throw InputError(file_, "is damaged: a list is longer than the file");
        return static_cast<std::size_t>(count);
    }
    void take(void* to, std::size_t size) {
        if (size > left_) throw InputError(file_, "is damaged: it ends too early");
        if (size == 0) return;
        std::memcpy(to, data_, size);
        data_ += size;
        left_ -= size;
    }

    const std::filesystem::path& file_;
    const std::uint8_t* data_;
    std::size_t left_;
};

void require(bool holds, const std::filesystem::path& file, const char* what) {
    if (!holds) throw InputError(file, what);
}

}  // namespace

std::uint64_t state_hash(const ClothState& state) {
    const std::uint64_t positions = hash_bytes(state.x.data(), state.x.size() * sizeof(Vec3));
    return hash_bytes(state.v.data(), state.v.size() * sizeof(Vec3), positions);
}

void write_record(const std::filesystem::path& file, std::uint64_t scene_hash, const FrameRecord& record) {
    RecordWriter out;
    out.append(record_magic.data(), record_magic.size());
    out(scene_hash);
    members(out, record);
    out(hash_bytes(out.bytes().data(), out.bytes().size()));
    write_whole_file(file, out.bytes());
}

FrameRecord read_record(const std::filesystem::path& file, std::uint64_t scene_hash, std::size_t particles,
                        std::size_t springs) {
    return parse_record(read_whole_file(file, largest_file), file, scene_hash, particles, springs);
}

FrameRecord parse_record(std::span<const std::uint8_t> bytes, const std::filesystem::path& file,
                         std::uint64_t scene_hash, std::size_t particles, std::size_t springs) {
    const std::size_t tail = sizeof(std::uint64_t);
    require(bytes.size() > record_magic.size() + 2 * tail &&
                std::memcmp(bytes.data(), record_magic.data(), record_magic.size()) == 0,
            file, "is no frame record of this version");
    std::uint64_t stored = 0;
    std::memcpy(&stored, bytes.data() + bytes.size() - tail, tail);
    require(stored == hash_bytes(bytes.data(), bytes.size() - tail), file,
            "is damaged: its checksum does not match");

    RecordReader in(file, bytes.data() + record_magic.size(), bytes.size() - record_magic.size() - tail);
    std::uint64_t scene = 0;
    in(scene);
    require(scene == scene_hash, file, "was made from another scene");
    FrameRecord r;
    members(in, r);
    require(in.left() == 0, file, "is damaged: it goes on after its end");
    const auto sized = [&](const auto& v, std::size_t n) { return v.size() == n; };
    const auto sized_or_empty = [&](const auto& v) { return v.empty() || v.size() == particles; };
    require(sized(r.state.x, particles) && sized(r.state.v, particles) && sized(r.state.dv, particles) &&
                sized_or_empty(r.state.x_previous) && sized_or_empty(r.state.v_previous) &&
                sized(r.component, particles) && sized(r.free, particles) && sized(r.springs, springs),
            file, "does not fit the scene's cloth");
    for (const Contact& c : r.state.contacts) {
        require(c.particle < particles, file, "is damaged: a contact names no particle");
    }
    const std::int32_t components = static_cast<std::int32_t>(
        std::min<std::size_t>(r.solves.size(), std::numeric_limits<std::int32_t>::max()));
    for (const std::int32_t c : r.component) {
        // Before the first step there is one component and no solve.
        require(c >= -1 && c < std::max(components, 1), file,
                "is damaged: a particle's component is not there");
    }
    for (const ComponentSolve& s : r.solves) {
        require(static_cast<std::uint8_t>(s.by) < solver_count &&
                    static_cast<std::uint8_t>(s.because) < solve_reason_count,
                file, "is damaged: a component's solver is none");
    }
    for (const SpringState s : r.springs) {
        require(s <= SpringState::implicit, file, "is damaged: a spring has no such state");
    }
    return r;
}

}  // namespace unravel::sim
