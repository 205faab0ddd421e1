# What rosin's headers include of others: Eigen from 3.4 on (5 as well) and Boost.Math from 1.74 on. Targets that a parent has already are
# taken, else the packages are looked for. Used where rosin is built and, installed with it, where it is found.
# Sets rosin_links to the targets, and rosin_lacks to a sentence where one is missing.
set(rosin_links "")
set(rosin_lacks "")

if(NOT TARGET Eigen3::Eigen)
  # Without a version: Eigen 5 does not answer to 3.4, and which of several is found first is the user's choice.
  find_package(Eigen3 QUIET NO_MODULE)
  if(Eigen3_VERSION AND Eigen3_VERSION VERSION_LESS 3.4)
    string(APPEND rosin_lacks "Eigen 3.4 or later is needed, ${Eigen3_DIR} has ${Eigen3_VERSION}. ")
  endif()
endif()
if(NOT TARGET Boost::headers AND NOT TARGET Boost::boost AND NOT TARGET Boost::math)
  find_package(Boost 1.74 QUIET CONFIG)
endif()

if(TARGET Eigen3::Eigen)
  list(APPEND rosin_links Eigen3::Eigen)
else()
  string(APPEND rosin_lacks "There is neither a target Eigen3::Eigen nor a package Eigen3: add its folder to CMAKE_PREFIX_PATH or set Eigen3_DIR. ")
endif()
if(TARGET Boost::headers)
  list(APPEND rosin_links Boost::headers)
elseif(TARGET Boost::boost)
  list(APPEND rosin_links Boost::boost)
elseif(TARGET Boost::math)
  list(APPEND rosin_links Boost::math)
else()
  string(APPEND rosin_lacks "There is neither a target Boost::headers nor a package Boost from 1.74 on: add its folder to CMAKE_PREFIX_PATH or set Boost_DIR. ")
endif()
