#include "tests/allocations.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local long allocations = 0;

}  // namespace

// Every form but the aligned ones, which are libstdc++'s own pair: sanitizers have forms of their own that do
// not come here by themselves.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size > 0 ? size : 1);
}
void* operator new(std::size_t size) {
    if (void* memory = operator new(size, std::nothrow)) return memory;
    throw std::bad_alloc();
}
void* operator new[](std::size_t size) {
    return operator new(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return operator new(size, std::nothrow);
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace unravel::testing {

AllocationCount::AllocationCount() : before_(allocations) {}

long AllocationCount::so_far() const {
    return allocations - before_;
}

}  // namespace unravel::testing
