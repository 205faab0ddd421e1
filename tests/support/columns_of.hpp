// SPDX-License-Identifier: MIT
// The values of a table that has to be readable, column by column.
#pragma once

#include <rosin/core/outcome.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace test {

using columns = std::vector<std::vector<double>>;

template <class Table>
columns columns_of(const rosin::outcome<Table>& read) {
  CHECK(read.error() == "");
  columns out;
  if (read)
    for (const auto& c : read->data.columns) out.push_back(c.values);
  return out;
}

}  // namespace test
