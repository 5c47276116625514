# The libraries of the exact oracles of the tests and of tandem-bench hard: MPFR, GMP and the headers of
# Boost.Multiprecision. The target tandem_oracles exists if all of them do.
find_path(TANDEM_MPFR_INCLUDE_DIR mpfr.h)
find_library(TANDEM_MPFR_LIBRARY mpfr)
find_library(TANDEM_GMP_LIBRARY gmp)
find_path(TANDEM_BOOST_INCLUDE_DIR boost/multiprecision/mpfr.hpp)
mark_as_advanced(TANDEM_MPFR_INCLUDE_DIR TANDEM_MPFR_LIBRARY TANDEM_GMP_LIBRARY TANDEM_BOOST_INCLUDE_DIR)

if(TANDEM_MPFR_INCLUDE_DIR AND TANDEM_MPFR_LIBRARY AND TANDEM_GMP_LIBRARY AND TANDEM_BOOST_INCLUDE_DIR)
  add_library(tandem_oracles INTERFACE)
  target_include_directories(
    tandem_oracles SYSTEM INTERFACE ${TANDEM_MPFR_INCLUDE_DIR} ${TANDEM_BOOST_INCLUDE_DIR}
  )
  target_link_libraries(tandem_oracles INTERFACE ${TANDEM_MPFR_LIBRARY} ${TANDEM_GMP_LIBRARY})
elseif(TANDEM_TESTS)
  message(FATAL_ERROR "Tandem: the tests need MPFR, GMP and Boost.Multiprecision; on Debian and Ubuntu install "
                      "libmpfr-dev, libgmp-dev and libboost-dev, or configure with -DTANDEM_TESTS=OFF")
endif()
