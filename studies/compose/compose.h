#pragma once

// Composes a part of zones of cells: which designs of a family, in which shares of the area, make the worst of all
// goals as good as it can be. The study behind `retrace compose`.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "studies/compose/mixture.h"
#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// How the angles between facets are spread, Gaussian and independent: in minutes of arc.
struct ErrorSpread {
  double cell_sigma_arcmin = 0.0;  ///< from cell to cell, which averages out over a zone
  double zone_sigma_arcmin = 0.0;  ///< from zone to zone, the same in all cells of one, which does not
  std::size_t parts = 1024;        ///< that are drawn
  /// Fraction of the random parts that counts as the worst. If it is given, a further part is optimized for these
  /// parts.
  std::optional<double> worst_share;
};

struct ComposeRequest {
  std::vector<std::string> goals;                     ///< quantities, the least of which is to be as large as it can be
  std::vector<Constraint> of_cells;                   ///< a cell that breaks one is none of the family
  std::vector<Constraint> of_part;                    ///< on means over the part
  std::vector<std::pair<std::string, double>> price;  ///< what one more of the mean of a quantity takes from the merit
  std::optional<FrontAxis> front;                     ///< the mean that the least goal is told against
  std::size_t front_points = 9;
  std::optional<double> least_goal;  ///< a part that does not reach it is none
  double least_share = 0.0;          ///< of a zone
  double most_share = 1.0;
  std::optional<std::size_t> most_zones;  ///< none: as many as serve
  std::size_t scan = 65;                  ///< cells of the first look, for each combination of discrete values
  std::size_t rounds = 4;                 ///< searches by prices, at most
  std::size_t starts = 3;                 ///< cells from which each goes out
  int looks = 20;                         ///< cells that are looked at from each
  std::optional<ErrorSpread> errors;
};

/// A cell of the family: a design that was looked at.
struct FamilyCell {
  std::uint64_t point = 0;  ///< in the store
  PointValues values;
  MixedCell mixed;  ///< goals in the request's order; means are those of `of_part`, then that of the front
};

struct Zone {
  FamilyCell cell;
  double share = 0.0;
};

/// A part with so many zones at most.
struct PartOfZones {
  std::vector<Zone> zones;     ///< the largest first
  Mixture mixture;             ///< whose cells are numbers in the catalogue
  std::size_t most_zones = 0;  ///< that were allowed
};

/// A part on the front, of a mean and the merit.
struct FrontPart {
  double mean = 0.0;
  double least = 0.0;
  std::vector<Zone> zones;
};

/// Of parts that are drawn.
struct PartYield {
  std::vector<double> leasts;           ///< their least goals, the lowest first
  std::optional<std::size_t> good;      ///< how many reach what is asked
  std::optional<double> mean_of_worst;  ///< of the share of the worst that is asked for
};

/// Composition that is optimized for the worst random parts: the mean of the minimum goal over these parts is maximal.
/// Its cells are chosen from the best compositions of all numbers of zones.
struct PartForWorst {
  std::vector<Zone> zones;  ///< the largest first
  PartYield yield;
};

/// What errors of the angles between facets make of a part.
struct ErrorEffects {
  std::vector<double> goals;                ///< with what spreads from cell to cell alone
  std::vector<std::vector<double>> slopes;  ///< of the least goal, per minute of arc, by zone and angle; shares follow
  PartYield yield;
  std::optional<PartForWorst> for_worst;
  double missed_by = 0.0;  ///< no goal of the part is missed by more where polynomials were held against computed ones
};

/// What is known about how good the part is.
enum class Proof {
  family,     ///< all cells of the family were looked at: nothing is better
  catalogue,  ///< nothing is better of the cells that were looked at
  none        ///< the search among these was cut short
};

struct Composition {
  std::vector<FamilyCell> catalogue;  ///< all cells that satisfy the constraints, in the order of their evaluation
  std::optional<PartOfZones> best;    ///< none if no mixture holds the bounds
  std::string none_because;           ///< then, which bounds exclude all
  std::optional<FamilyCell> single;   ///< the best part of one kind of cell, as `optimise` finds it
  Proof proof = Proof::none;
  bool has_converged = false;         ///< the last search by prices found nothing that helps
  double unlimited = 0.0;             ///< merit with any number of zones, of any share
  std::vector<PartOfZones> by_zones;  ///< the best of 1, 2, ... zones at most, up to one more than the best has
  std::vector<FrontPart> front;
  std::optional<ErrorEffects> errors;
  std::size_t failed = 0;  ///< designs that could not be computed
  std::string first_failure;
  std::size_t evaluations = 0;
  bool complete = true;
};

/// Returns the zones of the composition that is optimized for the worst random parts. Returns an empty list if there is
/// none.
std::vector<Zone> zones_for_worst(const Composition& composition);

StoreLayout compose_layout(const Study& study);

/// The cells of the first look as points of a sweep, for who wants them in the store before the search.
/// \throw InputError for too many combinations of discrete values
Sweep compose_scan(const Study& study, const ComposeRequest& request);

/// Searches for the mixture of cells that makes the best part. First, the family of cells is scanned, and `optimise`
/// improves the best cells of the scan. Then cells are added that improve the mixture according to the dual prices of
/// its linear programme (column generation). The search ends when no further cell improves the mixture. Cells that are
/// already in the store are not computed again, and the result is the same.
/// \throw OutputError as ResultStore::record()
Composition compose(const Study& study, const ComposeRequest& request, ResultStore& store, OptimiseObserver* observer,
                    const Cancellation* cancel);

}  // namespace retrace::studies
