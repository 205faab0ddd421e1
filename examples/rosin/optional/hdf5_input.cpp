// SPDX-License-Identifier: MIT
#include "../rig_input.hpp"

#include <rosin/adapt/table_hdf5.hpp>

namespace tool {

void add_hdf5_tables(rosin::table_formats& to) {
  to.push_back({".h5", rosin::read_hdf5});
  to.push_back({".hdf5", rosin::read_hdf5});
}

}  // namespace tool
