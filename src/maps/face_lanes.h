// The kernels of face_kernels.h, for whatever level of instruction set a file that includes this is
// compiled for. The formulas are those of `FaceEnergy`, for faces that are not large.
#pragma once

#include "maps/definite_lanes.h"
#include "maps/triangles_of_faces.h"

namespace {

FaceSums sums(const FaceLists& lists, const PointRows& points, std::uint32_t begin,
              std::uint32_t end, LeftOut& left_out) {
  Lanes energy = {}, area = {};
  LaneMask folded = {};
  for (std::uint32_t first = begin; first < end; first += kLanes) {
    const LaneFaces faces(lists, first, end);
    const LaneTriangle t = triangleOf(lists, points, first, end);
    const LaneMask here = faces.active & ~t.large;
    leaveOut(faces.active & t.large, first, left_out);
    area += select0(here, t.area);
    folded |= here & ~t.surelyPositive();
    Lanes value = areaCost(faces, t).value;
    if (faces.shape > 0) {
      const Lanes over_sums = t.overSums(), scale = edgeScale(faces);
      for (int i = 0; i < 3; ++i) value += sideCost(t, i, over_sums, scale).value;
    }
    energy += select0(here, value);
  }
  const bool infinite = lists.cost == AreaCost::barrier && any(folded);
  return {infinite ? kInfinity : sum(energy), sum(area)};
}

void areas(const FaceLists& lists, const PointRows& points, std::uint32_t begin, std::uint32_t end,
           double* areas, LeftOut& left_out) {
  for (std::uint32_t first = begin; first < end; first += kLanes) {
    const LaneTriangle t = triangleOf(lists, points, first, end);
    for (int k = 0; k < kLanes && first + k < end; ++k) {
      areas[first + k] = t.area[k];
      if (t.large[k]) left_out.faces[left_out.count++] = first + k;
    }
  }
}

/// The gradient and the Hessian of faces by tangent coordinates of their corners.
struct LaneTerms {
  Lanes2 gradient[3];
  LaneBlock diagonal[3], coupling[3];  // of each corner with the next one
};

inline LaneTerms areaTerms(const LaneFrame (&corners)[3], const LaneTriangle& t,
                           const Lanes& over_sums, const Cost<Lanes>& cost, FaceHessian hessian) {
  const Lanes over = 0.5 * over_sums;
  const Lanes alpha = t.triple_product * over, beta = t.denominator * over;
  CornerSlope slopes[3];
  for (int i = 0; i < 3; ++i) {
    const Lanes3 &next = corners[(i + 1) % 3].point, &last = corners[(i + 2) % 3].point;
    slopes[i] = cornerSlope(corners[i], next, last, alpha, beta);
  }
  const bool linear = hessian == FaceHessian::gauss_newton;
  const Lanes stiffness = 4 * cost.bend, bend = linear ? Lanes{} : -2 * cost.slope;
  LaneTerms terms;
  for (int i = 0; i < 3; ++i) {
    terms.gradient[i] = 2 * cost.slope * slopes[i].v;
    terms.diagonal[i] = slopes[i].block(stiffness, bend);
    terms.coupling[i] = linear ? outer(stiffness * slopes[i].v, slopes[(i + 1) % 3].v)
                               : coupling(corners, slopes, i, stiffness, bend, alpha, beta);
  }
  return terms;
}

/// Adds the gradient and the block of an edge at one of its ends; `other` is the other end in the
/// tangent coordinates of this one.
inline void addEdge(const Cost<Lanes>& cost, const Lanes2& other, const Lanes& cosine,
                    Lanes2& gradient, LaneBlock& diagonal) {
  const Lanes radial = cost.slope * cosine;
  gradient = gradient + cost.slope * other;
  diagonal = diagonal + outer(cost.bend * other, other);
  diagonal.xx -= radial;
  diagonal.yy -= radial;
}

/// Adds the gradients and blocks of the edges.
/// @return their energy.
inline Lanes addEdges(const LaneFaces& faces, const LaneFrame (&corners)[3], const LaneTriangle& t,
                      const Lanes& over_sums, LaneTerms& terms) {
  const Lanes scale = edgeScale(faces);
  Lanes value = {};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, opposite = (i + 2) % 3;
    const Cost<Lanes> cost = sideCost(t, opposite, over_sums, scale);
    const Lanes2 at_i = corners[i].coordinates(t.sides[opposite]);
    const Lanes2 at_j = corners[j].coordinates(negative(t.sides[opposite]));
    const Lanes cosine = t.sum(opposite) - 1;
    value += cost.value;
    addEdge(cost, at_i, cosine, terms.gradient[i], terms.diagonal[i]);
    addEdge(cost, at_j, cosine, terms.gradient[j], terms.diagonal[j]);
    const Lanes2 x = corners[i].coordinates(corners[j].x), y = corners[i].coordinates(corners[j].y);
    terms.coupling[i] = terms.coupling[i] + outer(cost.bend * at_i, at_j) +
                        scaled(cost.slope, {x.x, x.y, y.x, y.y});
  }
  return value;
}

inline void makeDefinite(LaneTerms& terms, const LaneMask& active) {
  LaneMatrix6 m;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const LaneBlock &own = terms.diagonal[i], &pair = terms.coupling[i];
    m.at(2 * i, 2 * i) = own.xx;
    m.at(2 * i + 1, 2 * i) = own.yx;
    m.at(2 * i + 1, 2 * i + 1) = own.yy;
    m.at(2 * i, 2 * j) = pair.xx;
    m.at(2 * i + 1, 2 * j) = pair.yx;
    m.at(2 * i, 2 * j + 1) = pair.xy;
    m.at(2 * i + 1, 2 * j + 1) = pair.yy;
  }
  makeDefinite(m, active);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    terms.diagonal[i] = {m.at(2 * i, 2 * i), m.at(2 * i + 1, 2 * i), m.at(2 * i + 1, 2 * i),
                         m.at(2 * i + 1, 2 * i + 1)};
    terms.coupling[i] = {m.at(2 * i, 2 * j), m.at(2 * i + 1, 2 * j), m.at(2 * i, 2 * j + 1),
                         m.at(2 * i + 1, 2 * j + 1)};
  }
}

inline void store(const LaneTerms& terms, std::uint32_t count, FaceTerms* to) {
  const auto& g = terms.gradient;
  const LaneBlock blocks[8] = {{g[0].x, g[0].y, g[1].x, g[1].y},
                               {g[2].x, g[2].y, {}, {}},
                               terms.diagonal[0],
                               terms.diagonal[1],
                               terms.diagonal[2],
                               terms.coupling[0],
                               terms.coupling[1],
                               terms.coupling[2]};
  static_assert(sizeof(FaceTerms) == 8 * sizeof(Four));
  for (int part = 0; part < kLanes / 4; ++part) {
    for (int b = 0; b < 8; ++b) {
      Four values[4] = {fourOf(blocks[b].xx, part), fourOf(blocks[b].yx, part),
                        fourOf(blocks[b].xy, part), fourOf(blocks[b].yy, part)};
      transpose(values);
      for (std::uint32_t k = 0; k < 4 && 4 * part + k < count; ++k) {
        std::memcpy(reinterpret_cast<char*>(to + 4 * part + k) + b * sizeof(Four), &values[k],
                    sizeof(Four));
      }
    }
  }
}

double terms(const FaceLists& lists, const double* places, std::uint32_t begin, std::uint32_t end,
             FaceHessian hessian, FaceTerms* to, LeftOut& left_out) {
  Lanes energy = {};
  for (std::uint32_t first = begin; first < end; first += kLanes) {
    const LaneFaces faces(lists, first, end);
    LaneFrame corners[3];
    for (int i = 0; i < 3; ++i) {
      std::uint32_t rows[kLanes];
      cornerRows(lists, i, first, end, rows);
      gather(places, rows, corners[i]);
    }
    const LaneTriangle t(corners[0].point, corners[1].point, corners[2].point);
    const LaneMask here = faces.active & ~t.large;
    leaveOut(faces.active & t.large, first, left_out);
    const Cost<Lanes> cost = areaCost(faces, t);
    const Lanes over_sums = t.overSums();
    LaneTerms terms = areaTerms(corners, t, over_sums, cost, hessian);
    Lanes value = cost.value;
    if (faces.shape > 0) value += addEdges(faces, corners, t, over_sums, terms);
    energy += select0(here, value);
    if (hessian == FaceHessian::definite) makeDefinite(terms, here);
    store(terms, end - first, to + first);
  }
  return sum(energy);
}

struct LaneRing {
  std::uint32_t next[kLanes], last[kLanes];

  LaneRing(const RingLists& ring, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t k = 0; k < kLanes; ++k) {
      const std::uint32_t slot = first + k < end ? first + k : end - 1;
      next[k] = static_cast<std::uint32_t>(ring.next[slot]);
      last[k] = static_cast<std::uint32_t>(ring.last[slot]);
    }
  }
};

inline double ringSum(const RingLists& lists, const Lanes& value, const LaneMask& positive) {
  return lists.cost == AreaCost::barrier && any(~positive) ? kInfinity : sum(value);
}

inline Lanes3 broadcast(const double* vector) {
  return {vector[0] - Lanes{}, vector[1] - Lanes{}, vector[2] - Lanes{}};
}

bool ringTerms(const RingLists& lists, const double* places, std::uint32_t begin, std::uint32_t end,
               const double* place, RingTerms& terms) {
  using spherical_springs::core::kPlaceSize;
  const LaneFrame own = {broadcast(place + 6), broadcast(place), broadcast(place + 3)};
  Lanes value = {};
  Lanes2 gradient = {};
  LaneBlock block = {};
  LaneMask positive = ~LaneMask{};
  for (std::uint32_t first = begin; first < end; first += kLanes) {
    const LaneFaces faces(lists, first, end);
    const LaneRing ring(lists, first, end);
    const Lanes3 next = gatherPoints({places + 6, kPlaceSize}, ring.next);
    const Lanes3 last = gatherPoints({places + 6, kPlaceSize}, ring.last);
    const LaneTriangle t(own.point, next, last);
    if (any(t.large)) return false;
    positive &= t.surelyPositive();
    const Cost<Lanes> cost = areaCost(faces, t);
    const Lanes over_sums = t.overSums(), over = 0.5 * over_sums;
    const CornerSlope slope =
        cornerSlope(own, next, last, t.triple_product * over, t.denominator * over);
    Lanes own_value = cost.value;
    Lanes2 own_gradient = 2 * cost.slope * slope.v;
    LaneBlock own_block = slope.block(4 * cost.bend, -2 * cost.slope);
    if (faces.shape > 0) {
      const Lanes scale = edgeScale(faces);
      own_value += sideCost(t, 0, over_sums, scale).value;
      for (int i = 1; i < 3; ++i) {
        const Cost<Lanes> edge = sideCost(t, i, over_sums, scale);
        own_value += edge.value;
        addEdge(edge, own.coordinates(i == 1 ? negative(t.sides[1]) : t.sides[2]), t.sum(i) - 1,
                own_gradient, own_block);
      }
    }
    value += select0(faces.active, own_value);
    gradient = gradient +
               Lanes2{select0(faces.active, own_gradient.x), select0(faces.active, own_gradient.y)};
    block.xx += select0(faces.active, own_block.xx);
    block.xy += select0(faces.active, own_block.xy);
    block.yy += select0(faces.active, own_block.yy);
  }
  terms = {ringSum(lists, value, positive),
           {sum(gradient.x), sum(gradient.y)},
           {sum(block.xx), sum(block.xy), sum(block.yy)}};
  return true;
}

bool ringValue(const RingLists& lists, const PointRows& points, std::uint32_t begin,
               std::uint32_t end, const double* point, double& result) {
  const Lanes3 own = broadcast(point);
  Lanes value = {};
  LaneMask positive = ~LaneMask{};
  for (std::uint32_t first = begin; first < end; first += kLanes) {
    const LaneFaces faces(lists, first, end);
    const LaneRing ring(lists, first, end);
    const LaneTriangle t(own, gatherPoints(points, ring.next), gatherPoints(points, ring.last));
    if (any(t.large)) return false;
    positive &= t.surelyPositive();
    Lanes own_value = areaCost(faces, t).value;
    if (faces.shape > 0) {
      const Lanes over_sums = t.overSums(), scale = edgeScale(faces);
      for (int i = 0; i < 3; ++i) own_value += sideCost(t, i, over_sums, scale).value;
    }
    value += select0(faces.active, own_value);
  }
  result = ringSum(lists, value, positive);
  return true;
}

}  // namespace

namespace spherical_springs::mesh {

/// This file's own.
static constexpr FaceKernels kKernels = {sums, areas, terms, ringTerms, ringValue};

}  // namespace spherical_springs::mesh
