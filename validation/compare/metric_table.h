// What there is to know of each metric besides how it is computed.
#pragma once

#include "penumbra/compare.h"

#include <optional>
#include <span>
#include <string_view>

namespace penumbra::metrics {

/// The part of a picture that a metric is of.
enum class Part { whole, covered, edges };

/// What a value is. The error that it tells is its distance from 1 where its limit is a minimum,
/// else its magnitude; of decibels it is the ratio.
enum class Scale {
    number,
    share,     ///< of the pixels, in [0, 1]
    decibel,   ///< of a ratio of amplitudes
    no_error,  ///< it is not about errors
};

/// What the profiles allow. Metrics without are parts of others or depend on what a picture shows,
/// so that no limit makes sense for any pair.
struct ProfileLimits {
    std::optional<double> strict = {}, equivalent = {}, similar = {};
};

struct MetricKind {
    std::string_view name = {};
    bool at_least = true;  ///< its limit is a minimum (else a maximum of the magnitude)
    Scale scale = Scale::number;
    Part part = Part::whole;
    std::string_view description = {};  ///< plain text; empty: as of the same figure of the whole
    ProfileLimits limits = {};
    bool by_default = false;            ///< its equivalent limit holds where no profile is named
    std::optional<double> always = {};  ///< its limit where none is given
};

/// All metrics, in the order in which compare() gives them and reports show them.
std::span<const MetricKind> metric_kinds();

/// The entry of that name; null when there is none, as for a report of another version.
const MetricKind* metric_kind(std::string_view name);

/// The part of the error that a limit allows which the metric has: 1 at the limit. NaN where there
/// is no limit, or it says nothing of errors.
double limit_use(const Metric& metric);

}  // namespace penumbra::metrics
