#pragma once

// Interval arithmetic from Boost, for proofs that a function keeps within a bound over a whole region.

// These are the headers that <boost/numeric/interval.hpp> includes, without the headers for the rounding modes of
// processors. Those modes are not available on every processor.
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
