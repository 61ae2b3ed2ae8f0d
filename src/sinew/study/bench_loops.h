// Loops that only load the machine; their rates bound all other loops. For every instruction set of
// the processor.
#pragma once

#include <cstddef>
#include <string>

namespace sinew::study {

// to = from (floats).
void copy_floats(const float* from, float* to, std::size_t count);
// a = b + c / 2 (floats).
void triad_floats(const float* b, const float* c, float* a, std::size_t count);
// Independent multiply-adds, `rounds` times; returns the number of floating-point operations: two
// for each lane.
double multiply_add(std::size_t rounds);

// Floats in a vector of the loops above, and the name of the instruction set: "AVX3", "NEON".
std::size_t float_lanes();
std::string instruction_set();

// Clock cycles of a chain of dependent additions, `rounds` times: one each, on every processor.
double cycles(std::size_t rounds);

}  // namespace sinew::study
