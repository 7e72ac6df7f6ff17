#include "tool/bench/peers.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "tool/base/program.hpp"
#include "tool/bench/cholmod_solve.hpp"

namespace unravel::tool {

namespace {

class Clock {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The library that holds tool/bench/cholmod_solve.cpp, opened when it is first asked for, so
// that nobody else pays for CHOLMOD and its BLAS. Stays open.
decltype(&unravel_cholmod_solve) cholmod() {
    static const auto found = []() -> decltype(&unravel_cholmod_solve) {
        // One thread, as Eigen has.
        setenv("OPENBLAS_NUM_THREADS", "1", 0);
        setenv("OMP_NUM_THREADS", "1", 0);
        // Beside the program where that was built, in a folder of its own where it is installed.
        const std::filesystem::path beside = program_file().parent_path();
        void* library = nullptr;
        for (const auto& folder : {beside, beside.parent_path() / "lib" / "unravel"}) {
            if (!library) library = dlopen((folder / "libunravel_cholmod.so").c_str(), RTLD_NOW | RTLD_LOCAL);
        }
        return library ? reinterpret_cast<decltype(&unravel_cholmod_solve)>(
                             dlsym(library, "unravel_cholmod_solve"))
                       : nullptr;
    }();
    return found;
}

}  // namespace

PeerSolve solve_by_eigen_cg(const FoldedSystem& system, double tolerance, int most) {
    PeerSolve out;
    const Clock clock;
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> cg;
    cg.setTolerance(tolerance);
    cg.setMaxIterations(most);
    cg.compute(system.A);
    out.set_up = clock.seconds();
    out.y = cg.solveWithGuess(system.b, system.start);
    out.seconds = clock.seconds();
    out.iterations = static_cast<int>(cg.iterations());
    return out;
}

PeerSolve solve_by_eigen_ldlt(const FoldedSystem& system) {
    PeerSolve out;
    const Clock clock;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(system.A);
    out.set_up = clock.seconds();
    out.y = factors.solve(system.b);
    out.seconds = clock.seconds();
    return out;
}

std::optional<PeerSolve> solve_by_cholmod(const FoldedSystem& system) {
    if (!cholmod()) return std::nullopt;
    const Eigen::SparseMatrix<double> lower = system.A.triangularView<Eigen::Lower>();
    PeerSolve out;
    out.y.resize(system.b.size());
    const Clock clock;
    const bool solved =
        cholmod()(static_cast<int>(lower.rows()), lower.outerIndexPtr(), lower.innerIndexPtr(),
                  lower.valuePtr(), system.b.data(), out.y.data(), &out.set_up) == 0;
    out.seconds = clock.seconds();
    if (!solved) return std::nullopt;
    return out;
}

std::string cholmod_missing() {
    if (cholmod()) return "";
    return "CHOLMOD was not there when the tool was built: apt-get install libsuitesparse-dev, then "
           "cmake --preset release and build again";
}

}  // namespace unravel::tool
