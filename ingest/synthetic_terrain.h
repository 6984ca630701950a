#pragma once

#include <cstdint>

namespace terrane::ingest {

/// Height in metres of a caldera over fractal hills at (x, y), each from -1 to 1 over the DEM's
/// shorter side.
///
/// A ring of mountains (radius 0.5, about 1,500 m) holds a lake that lies flat at exactly 800 m,
/// with an island in it. Only + - * / and square roots of IEEE doubles, which round alike on every
/// machine: the same arguments give the same bits everywhere.
double caldera_height_m(double x, double y, std::uint64_t seed);

/// A number from 0 to just below 1 that depends on the key alone.
double hashed_fraction(std::uint64_t seed, std::uint64_t stream, std::int64_t i, std::int64_t j);

}  // namespace terrane::ingest
