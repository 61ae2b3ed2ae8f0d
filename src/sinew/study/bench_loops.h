// Loops that do nothing but load the machine: what bounds all others. For every instruction set
// that the processor may have.
#pragma once

#include <cstddef>
#include <string>

namespace sinew::study {

// to = from (floats).
void copy_floats(const float* from, float* to, std::size_t count);
// a = b + c / 2 (floats).
void triad_floats(const float* b, const float* c, float* a, std::size_t count);
// Multiply-adds that do not wait for one another, `rounds` times; returns how many floating-point
// operations that were: two for each lane.
double multiply_add(std::size_t rounds);

// Floats in a vector of the loops above, and the name of the instruction set: "AVX3", "NEON".
std::size_t float_lanes();
std::string instruction_set();

// Cycles of the clock that pass in a chain of dependent additions, `rounds` times: one each, on
// every processor.
double cycles(std::size_t rounds);

}  // namespace sinew::study
