// SPDX-License-Identifier: MIT
#pragma once
// The one place where the version is written. CMakeLists.txt reads it from here, so that a
// vendored copy of include/ still knows what it is.
#define ROSIN_VERSION_MAJOR 0
#define ROSIN_VERSION_MINOR 1
#define ROSIN_VERSION_PATCH 0
#define ROSIN_VERSION_STRING "0.1.0"
