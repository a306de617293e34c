#pragma once

// Interval arithmetic from Boost, for proofs that the values of a function are within a bound over a whole region.

// The following headers are those that <boost/numeric/interval.hpp> includes, except for the headers for the rounding
// modes of processors. Some processors do not have these modes.
#include <boost/limits.hpp>
#include <boost/numeric/interval/arith.hpp>
#include <boost/numeric/interval/arith2.hpp>
#include <boost/numeric/interval/arith3.hpp>
#include <boost/numeric/interval/checking.hpp>
#include <boost/numeric/interval/compare.hpp>
#include <boost/numeric/interval/constants.hpp>
#include <boost/numeric/interval/interval.hpp>
#include <boost/numeric/interval/policies.hpp>
#include <boost/numeric/interval/rounded_arith.hpp>
#include <boost/numeric/interval/rounded_transc.hpp>
#include <boost/numeric/interval/transc.hpp>
#include <boost/numeric/interval/utility.hpp>

namespace retrace {

/// Intervals that enclose real numbers, for proofs. Their bounds are not rounded outwards. The margins of the proofs
/// must therefore cover the rounding errors, which are below 1e-9 of typical values here. Include this header only in
/// .cpp files.
using Interval = boost::numeric::interval<
    double, boost::numeric::interval_lib::policies<boost::numeric::interval_lib::save_state_nothing<
                                                       boost::numeric::interval_lib::rounded_transc_exact<double>>,
                                                   boost::numeric::interval_lib::checking_base<double>>>;

}  // namespace retrace
