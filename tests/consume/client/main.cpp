// SPDX-License-Identifier: MIT
#include <strings.hpp>

int main() { return strings::middle_of({100, 200}) == 0.5 ? 0 : 1; }
