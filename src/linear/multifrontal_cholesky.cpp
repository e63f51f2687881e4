#include "linear/multifrontal_cholesky.h"

#include <algorithm>

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
  for (std::size_t p = 0; p < parts.size(); ++p) {
    rows[p] = parts[p].end - parts[p].first;
    first[p] = p;
    for (const std::uint32_t child : parts[p].children) {
      rows[p] += rows[child];
      first[p] = std::min(first[p], first[child]);
      parent[child] = p;
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (rows[p] > enough) {
      above_.push_back(p);
    } else if (parent[p] == kNone || rows[parent[p]] > enough) {
      subtrees_.emplace_back(first[p], p + 1);
    }
  }
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

void MultifrontalCholesky::assemble(const Part& part, const Blocks<double, 2>& values,
                                    Front& front) const {
  const Graph& graph = pattern_.graph;
  const std::size_t own = part.end - part.first;
  for (std::uint32_t place = part.first; place < part.end; ++place) {
    const std::uint32_t i = dissection_.order[place];
    const std::size_t column = place - part.first;
    for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
      const std::uint32_t other = dissection_.places[graph.neighbours[e]];
      if (other < place) continue;
      // The matrix is symmetric: the mirrored block is the transpose.
      const std::size_t row = positionOf(part, other);
      auto& target = row < own ? front.own : front.below;
      target.block<2, 2>(2 * (row < own ? row : row - own), 2 * column) = values[e].transpose();
    }
  }
}

/// Adds what a child has left, column by column of its lower triangle.
void MultifrontalCholesky::addChild(const Part& part, const Part& child, Front& front,
                                    Front& below) const {
  const std::size_t own = part.end - part.first, count = child.boundary.size();
  std::vector<std::size_t> positions(count);
  for (std::size_t k = 0; k < count; ++k) positions[k] = positionOf(part, child.boundary[k]);
  for (std::size_t c = 0; c < count; ++c) {
    const std::size_t column = positions[c];
    for (std::size_t r = c; r < count; ++r) {
      const std::size_t row = positions[r];
      auto& target = row < own ? front.own : column < own ? front.below : front.rest;
      target.block<2, 2>(2 * (row < own ? row : row - own),
                         2 * (column < own ? column : column - own)) +=
          below.rest.block<2, 2>(2 * r, 2 * c);
    }
  }
  below.rest.resize(0, 0);
}

void MultifrontalCholesky::factorise(std::size_t p, const Blocks<double, 2>& values) {
  checkpoint_();
  const Part& part = dissection_.parts[p];
  Front& front = fronts_[p];
  const auto own = 2 * static_cast<Eigen::Index>(part.end - part.first);
  const auto rest = static_cast<Eigen::Index>(2 * part.boundary.size());
  front.own.setZero(own, own);
  front.below.setZero(rest, own);
  front.rest.setZero(rest, rest);
  assemble(part, values, front);
  front.definite = true;
  for (const std::uint32_t child : part.children) {
    front.definite = front.definite && fronts_[child].definite;
    if (front.definite) addChild(part, dissection_.parts[child], front, fronts_[child]);
  }
  if (!front.definite) return;
  front.definite = eliminationKernels().eliminate(
      {front.own.data(), front.below.data(), front.rest.data(), own, rest});
}

bool MultifrontalCholesky::refresh(const Blocks<double, 2>& values) {
  forOnThreads(static_cast<std::ptrdiff_t>(subtrees_.size()), threads_, [&](std::ptrdiff_t s) {
    for (std::size_t p = subtrees_[s].first; p < subtrees_[s].second; ++p) factorise(p, values);
  });
  for (const std::size_t p : above_) factorise(p, values);
  return std::all_of(fronts_.begin(), fronts_.end(), [](const Front& f) { return f.definite; });
}

void MultifrontalCholesky::apply(const VectorOf<double>& residual, VectorOf<double>& correction) {
  const auto& parts = dissection_.parts;
  std::size_t longest = 0;
  for (const auto& part : parts) longest = std::max(longest, part.boundary.size());
  // Eigen's vectors do not survive it when there is no memory for another size.
  Eigen::VectorXd x(residual.size()), gathered(2 * longest);
  for (std::size_t place = 0; place < dissection_.order.size(); ++place) {
    x.segment<2>(2 * place) = residual.segment<2>(2 * dissection_.order[place]);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    checkpoint_();
    const auto own = fronts_[p].own.cols();
    auto part = x.segment(2 * parts[p].first, own);
    fronts_[p].own.triangularView<Eigen::Lower>().solveInPlace(part);
    if (parts[p].boundary.empty()) continue;
    gathered.head(fronts_[p].below.rows()).noalias() = fronts_[p].below * part;
    for (std::size_t k = 0; k < parts[p].boundary.size(); ++k) {
      x.segment<2>(2 * parts[p].boundary[k]) -= gathered.segment<2>(2 * k);
    }
  }
  for (std::size_t p = parts.size(); p-- > 0;) {
    checkpoint_();
    const auto own = fronts_[p].own.cols();
    auto part = x.segment(2 * parts[p].first, own);
    if (!parts[p].boundary.empty()) {
      for (std::size_t k = 0; k < parts[p].boundary.size(); ++k) {
        gathered.segment<2>(2 * k) = x.segment<2>(2 * parts[p].boundary[k]);
      }
      part.noalias() -= fronts_[p].below.transpose() * gathered.head(fronts_[p].below.rows());
    }
    fronts_[p].own.triangularView<Eigen::Lower>().transpose().solveInPlace(part);
  }
  correction.resize(residual.size());
  for (std::size_t place = 0; place < dissection_.order.size(); ++place) {
    correction.segment<2>(2 * dissection_.order[place]) = x.segment<2>(2 * place);
  }
}

}  // namespace spherical_springs::core
