#include "linear/multifrontal_cholesky.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "linear/elimination_kernels.h"

namespace spherical_springs::core {

MultifrontalCholesky::MultifrontalCholesky(const BlockPattern& pattern, int threads,
                                           Checkpoint checkpoint)
    : pattern_(pattern),
      threads_(threads),
      checkpoint_(std::move(checkpoint)),
      dissection_(nestedDissection(pattern.graph, checkpoint_)),
      fronts_(dissection_.parts.size()) {
  // Parts stand in postorder, so that a subtree is a range that ends with its root.
  const auto& parts = dissection_.parts;
  constexpr std::size_t kNone = ~std::size_t(0);
  const std::size_t enough = pattern.rows() / 16 + 1;  // rows of a subtree
  std::vector<std::size_t> rows(parts.size()), first(parts.size()), parent(parts.size(), kNone);
  std::vector<std::size_t> depths(parts.size(), 0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    rows[p] = parts[p].end - parts[p].first;
    first[p] = p;
    for (const std::uint32_t child : parts[p].children) {
      rows[p] += rows[child];
      first[p] = std::min(first[p], first[child]);
      parent[child] = p;
    }
  }
  for (std::size_t p = parts.size(); p-- > 0;) {
    if (parent[p] != kNone) depths[p] = depths[parent[p]] + 1;
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (rows[p] > enough) {
      levels_.resize(std::max(levels_.size(), depths[p] + 1));
      levels_[depths[p]].push_back(p);
    } else if (parent[p] == kNone || rows[parent[p]] > enough) {
      subtrees_.emplace_back(first[p], p + 1);
    }
  }
  layOut(depths);
}

void MultifrontalCholesky::layOut(const std::vector<std::size_t>& depths) {
  for (const Part& part : dissection_.parts) {
    for (const std::uint32_t child : part.children) {
      fronts_[child].runs = runsOf(dissection_.parts[child], part);
    }
    layOutEntries(part, fronts_[&part - dissection_.parts.data()]);
  }
  for (const auto& [begin, end] : subtrees_) {
    std::vector<std::size_t> numbers(end - begin);
    std::iota(numbers.begin(), numbers.end(), begin);
    layOutRests(numbers, depths);
  }
  layOutRestsOfLevels();
}

std::vector<MultifrontalCholesky::Run> MultifrontalCholesky::runsOf(const Part& child,
                                                                    const Part& parent) {
  const std::size_t own = parent.end - parent.first;
  std::vector<Run> runs;
  for (std::uint32_t r = 0; r < child.boundary.size(); ++r) {
    const std::size_t position = positionOf(parent, child.boundary[r]);
    const bool is_own = position < own;
    const auto to = static_cast<std::uint32_t>(is_own ? position : position - own);
    if (runs.empty() || runs.back().is_own != is_own ||
        runs.back().to + (r - runs.back().first) != to) {
      runs.push_back({r, r, to, is_own});
    }
    runs.back().end = r + 1;
  }
  return runs;
}

/// Rests of even and of odd depth stand on a stack each, as a part takes those of its children off
/// one when its own is on the other.
void MultifrontalCholesky::layOutRests(const std::vector<std::size_t>& numbers,
                                       const std::vector<std::size_t>& depths) {
  const auto sizeOf = [&](std::size_t p) { return restSize(p) * restSize(p); };
  std::array<Eigen::Index, 2> heights = {}, highest = {};
  std::vector<Eigen::Index> places;
  for (const std::size_t p : numbers) {
    const std::size_t stack = depths[p] % 2;
    places.push_back(heights[stack]);
    heights[stack] += sizeOf(p);
    highest[stack] = std::max(highest[stack], heights[stack]);
    for (const std::uint32_t child : dissection_.parts[p].children) {
      if (std::binary_search(numbers.begin(), numbers.end(), child)) {
        heights[1 - stack] -= sizeOf(child);
      }
    }
  }
  double* room = remains_.emplace_back(highest[0] + highest[1]).data();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    putRest(numbers[i], (depths[numbers[i]] % 2 == 0 ? room : room + highest[0]) + places[i]);
  }
}

/// The rests of a level lie side by side. Even levels share one piece of memory and odd levels
/// another, as a level is read only while the one above it is written.
void MultifrontalCholesky::layOutRestsOfLevels() {
  std::array<Eigen::Index, 2> highest = {};
  for (std::size_t depth = 0; depth < levels_.size(); ++depth) {
    Eigen::Index height = 0;
    for (const std::size_t p : levels_[depth]) height += restSize(p) * restSize(p);
    highest[depth % 2] = std::max(highest[depth % 2], height);
  }
  double* const room = remains_.emplace_back(highest[0] + highest[1]).data();
  for (std::size_t depth = 0; depth < levels_.size(); ++depth) {
    double* place = depth % 2 == 0 ? room : room + highest[0];
    for (const std::size_t p : levels_[depth]) {
      putRest(p, place);
      place += restSize(p) * restSize(p);
    }
  }
}

Eigen::Index MultifrontalCholesky::restSize(std::size_t part) const {
  return static_cast<Eigen::Index>(2 * dissection_.parts[part].boundary.size());
}

void MultifrontalCholesky::putRest(std::size_t part, double* place) {
  new (&fronts_[part].rest) Eigen::Map<Eigen::MatrixXd>(place, restSize(part), restSize(part));
}

double MultifrontalCholesky::work() const {
  double sum = 0;
  for (const Part& part : dissection_.parts) {
    const double own = 2. * (part.end - part.first);
    const double rest = 2. * static_cast<double>(part.boundary.size());
    sum += own * (own * own / 6 + own * rest / 2 + rest * rest / 2);
  }
  return sum;
}

std::size_t MultifrontalCholesky::positionOf(const Part& part, std::uint32_t place) {
  if (place < part.end) return place - part.first;
  const auto found = std::lower_bound(part.boundary.begin(), part.boundary.end(), place);
  return part.end - part.first + (found - part.boundary.begin());
}

void MultifrontalCholesky::layOutEntries(const Part& part, Front& front) const {
  const Graph& graph = pattern_.graph;
  for (std::uint32_t place = part.first; place < part.end; ++place) {
    const std::uint32_t i = dissection_.order[place];
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
      const std::uint32_t other = dissection_.places[graph.neighbours[e]];
      if (other < place) continue;
      front.entries.push_back(
          {e, static_cast<std::uint32_t>(positionOf(part, other)), place - part.first});
    }
  }
}

void MultifrontalCholesky::assemble(const Blocks<double, 2>& values, Front& front) {
  const auto own = static_cast<std::uint32_t>(front.own.cols() / 2);
  for (const auto& [place, row, column] : front.entries) {
    auto& target = row < own ? front.own : front.below;
    // The matrix is symmetric: the mirrored block is the transpose.
    target.block<2, 2>(2 * (row < own ? row : row - own), 2 * column) = values[place].transpose();
  }
}

/// Adds what a child has left to the columns of the front's own unknowns, or to the others, run by
/// run of the columns of the child's lower triangle.
void MultifrontalCholesky::addChild(Front& front, const Front& child, bool own_columns) {
  for (std::size_t i = 0; i < child.runs.size(); ++i) {
    const Run& across = child.runs[i];
    if (across.is_own != own_columns) continue;
    for (std::size_t j = i; j < child.runs.size(); ++j) {
      const Run& down = child.runs[j];
      auto& target = down.is_own ? front.own : front.below;
      const Eigen::Index stride = across.is_own ? target.rows() : front.rest.rows();
      double* first = across.is_own ? target.data() : front.rest.data();
      for (Eigen::Index c = 2 * across.first; c < 2 * across.end; ++c) {
        const Eigen::Index row = i == j ? c : 2 * down.first, rows = 2 * down.end - row;
        const Eigen::Index to = 2 * down.to + row - 2 * down.first;
        const Eigen::Index column = 2 * across.to + c - 2 * across.first;
        Eigen::Map<Eigen::VectorXd>(first + column * stride + to, rows) +=
            child.rest.col(c).segment(row, rows);
      }
    }
  }
}

void MultifrontalCholesky::factorise(std::size_t p, const Blocks<double, 2>& values) {
  checkpoint_();
  const Part& part = dissection_.parts[p];
  Front& front = fronts_[p];
  const auto own = 2 * static_cast<Eigen::Index>(part.end - part.first);
  const Eigen::Index rest = restSize(p);
  front.own.setZero(own, own);
  front.below.setZero(rest, own);
  assemble(values, front);
  front.definite = true;
  for (const std::uint32_t child : part.children) {
    front.definite = front.definite && fronts_[child].definite;
    if (front.definite) addChild(front, fronts_[child], true);
  }
  if (!front.definite) return;
  const Interlude check{
      [](const void* checkpoint) { (*static_cast<const Checkpoint*>(checkpoint))(); },
      &checkpoint_};
  front.definite = eliminationKernels().eliminate(
      {front.own.data(), front.below.data(), front.rest.data(), own, rest}, check);
  if (!front.definite) return;
  for (const std::uint32_t child : part.children) addChild(front, fronts_[child], false);
}

/// Visits children before their parents.
template <class Visitor>
void MultifrontalCholesky::visitUpwards(const Visitor& visit) {
  forOnThreads(static_cast<std::ptrdiff_t>(subtrees_.size()), threads_, [&](std::ptrdiff_t s) {
    for (std::size_t p = subtrees_[s].first; p < subtrees_[s].second; ++p) visit(p);
  });
  for (std::size_t depth = levels_.size(); depth-- > 0;) visitLevel(levels_[depth], visit);
}

/// Visits parents before their children.
template <class Visitor>
void MultifrontalCholesky::visitDownwards(const Visitor& visit) {
  for (const auto& level : levels_) visitLevel(level, visit);
  forOnThreads(static_cast<std::ptrdiff_t>(subtrees_.size()), threads_, [&](std::ptrdiff_t s) {
    for (std::size_t p = subtrees_[s].second; p-- > subtrees_[s].first;) visit(p);
  });
}

template <class Visitor>
void MultifrontalCholesky::visitLevel(const std::vector<std::size_t>& level, const Visitor& visit) {
  forOnThreads(static_cast<std::ptrdiff_t>(level.size()), threads_,
               [&](std::ptrdiff_t i) { visit(level[i]); });
}

bool MultifrontalCholesky::refresh(const Blocks<double, 2>& values) {
  visitUpwards([&](std::size_t p) { factorise(p, values); });
  return std::all_of(fronts_.begin(), fronts_.end(), [](const Front& f) { return f.definite; });
}

/// Solves for a part's own unknowns, in `x`, and leaves to the parent what they take from those of
/// its boundary.
void MultifrontalCholesky::forwards(std::size_t p, Eigen::VectorXd& x) {
  checkpoint_();
  const Part& part = dissection_.parts[p];
  Front& front = fronts_[p];
  auto own = x.segment(2 * part.first, front.own.cols());
  front.left.setZero(restSize(p));
  for (const std::uint32_t child : part.children) {
    for (const Run& run : fronts_[child].runs) {
      const Eigen::Index size = 2 * (run.end - run.first);
      const auto from = fronts_[child].left.segment(2 * run.first, size);
      if (run.is_own) {
        own.segment(2 * run.to, size) += from;
      } else {
        front.left.segment(2 * run.to, size) += from;
      }
    }
  }
  front.own.triangularView<Eigen::Lower>().solveInPlace(own);
  front.left.noalias() -= front.below * own;
}

void MultifrontalCholesky::backwards(std::size_t p, Eigen::VectorXd& x) {
  checkpoint_();
  const Part& part = dissection_.parts[p];
  Front& front = fronts_[p];
  auto own = x.segment(2 * part.first, front.own.cols());
  for (std::size_t k = 0; k < part.boundary.size(); ++k) {
    front.left.segment<2>(2 * k) = x.segment<2>(2 * part.boundary[k]);
  }
  own.noalias() -= front.below.transpose() * front.left;
  front.own.triangularView<Eigen::Lower>().transpose().solveInPlace(own);
}

void MultifrontalCholesky::apply(const VectorOf<double>& residual, VectorOf<double>& correction) {
  // Eigen's vectors do not survive it when there is no memory for another size.
  Eigen::VectorXd x(residual.size());
  for (std::size_t place = 0; place < dissection_.order.size(); ++place) {
    x.segment<2>(2 * place) = residual.segment<2>(2 * dissection_.order[place]);
  }
  visitUpwards([&](std::size_t p) { forwards(p, x); });
  visitDownwards([&](std::size_t p) { backwards(p, x); });
  correction.resize(residual.size());
  for (std::size_t place = 0; place < dissection_.order.size(); ++place) {
    correction.segment<2>(2 * dissection_.order[place]) = x.segment<2>(2 * place);
  }
}

}  // namespace spherical_springs::core
