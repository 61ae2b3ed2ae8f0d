// The option --scale, which info and convert share.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

// `scale` keeps its value if the option is not given.
inline void add_scale_option(CLI::App& command, double& scale) {
  const auto positive = [](const std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) {
      return std::string();
    }
    return "\"" + text + "\" is not a number above 0";
  };
  command
      .add_option("--scale", scale, "Factor from the file's unit to metres: 0.001 for millimetres")
      ->check(positive)
      ->type_name("FACTOR")
      ->default_str("1");
}
