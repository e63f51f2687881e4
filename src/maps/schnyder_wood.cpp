#include "maps/schnyder_wood.h"

#include <deque>

namespace spherical_springs::mesh {
namespace {

using Index = HalfEdges::Index;

/// Takes vertices off the disc one by one, from the third root on, each from the path that bounds
/// what is left between the other two; see H. de Fraysseix, J. Pach and R. Pollack, Combinatorica
/// 10 (1990), for why one without a chord is always there.
class Shelling {
 public:
  Shelling(const HalfEdges& edges, std::size_t vertices, Index without)
      : edges_(edges),
        state_(vertices, State::inside),
        chords_(vertices, 0),
        left_(vertices, HalfEdges::kNone),
        right_(vertices, HalfEdges::kNone),
        outgoing_(vertices, HalfEdges::kNone) {
    for (Index h = 0; h < edges.size(); ++h) outgoing_[edges.origin(h)] = h;
    const Index h = 3 * without;
    wood_.roots = {edges.origin(h), edges.origin(h + 2), edges.origin(h + 1)};
    wood_.parents.assign(vertices, {HalfEdges::kNone, HalfEdges::kNone, HalfEdges::kNone});
    wood_.corners.assign(edges.size() / 3, {HalfEdges::kNone, HalfEdges::kNone, HalfEdges::kNone});
  }

  SchnyderWood run() {
    const auto [left, right, top] = wood_.roots;
    for (const Index root : wood_.roots) state_[root] = State::path;
    join(left, top);
    join(top, right);
    remove(top);
    while (!ready_.empty()) {
      const Index v = ready_.front();
      ready_.pop_front();
      if (state_[v] == State::path && chords_[v] == 0) remove(v);
    }
    for (const Index root : wood_.roots) {
      wood_.parents[root] = {HalfEdges::kNone, HalfEdges::kNone, HalfEdges::kNone};
    }
    wood_.order.push_back(left);
    wood_.order.push_back(right);
    return std::move(wood_);
  }

 private:
  enum class State { inside, path, removed };

  void join(Index left, Index right) {
    right_[left] = right;
    left_[right] = left;
  }

  Index halfEdge(Index from, Index to) const {
    Index h = outgoing_[from];
    while (edges_.target(h) != to) h = edges_.turned(h);
    return h;
  }

  void remove(Index v) {
    const Index left = left_[v], right = right_[v];
    wood_.order.push_back(v);
    state_[v] = State::removed;
    wood_.parents[v][0] = left;
    wood_.parents[v][1] = right;
    uncovered_.clear();
    for (Index h = halfEdge(v, left); edges_.target(h) != right; h = edges_.turned(h)) {
      const Index next = edges_.target(edges_.turned(h));
      wood_.corners[HalfEdges::face(h)] = {edges_.target(h), next, v};
      if (next != right) uncovered_.push_back(next);
    }
    Index last = left;
    for (const Index w : uncovered_) {
      state_[w] = State::path;
      wood_.parents[w][2] = v;
      join(last, w);
      last = w;
    }
    join(last, right);
    if (uncovered_.empty()) {
      loseChord(left);
      loseChord(right);
    }
    for (const Index w : uncovered_) countChords(w);
    for (const Index w : uncovered_) makeReady(w);
  }

  /// The edge between the ends of a path that has shrunk to it was a chord of both.
  void loseChord(Index v) {
    --chords_[v];
    makeReady(v);
  }

  void countChords(Index w) {
    const Index begin = outgoing_[w];
    Index h = begin;
    do {
      const Index other = edges_.target(h);
      if (state_[other] == State::path && other != left_[w] && other != right_[w]) {
        ++chords_[w];
        // Others that were uncovered with it count their own.
        if (wood_.parents[other][2] != wood_.parents[w][2]) ++chords_[other];
      }
      h = edges_.turned(h);
    } while (h != begin);
  }

  void makeReady(Index v) {
    const bool end = v == wood_.roots[0] || v == wood_.roots[1];
    if (!end && chords_[v] == 0) ready_.push_back(v);
  }

  const HalfEdges& edges_;
  std::vector<State> state_;
  std::vector<Index> chords_, left_, right_;  // of vertices on the path
  std::vector<Index> outgoing_;               // a half-edge of each vertex
  std::vector<Index> uncovered_;
  std::deque<Index> ready_;
  SchnyderWood wood_;
};

}  // namespace

SchnyderWood schnyderWood(const HalfEdges& edges, std::size_t vertices, Index without) {
  return Shelling(edges, vertices, without).run();
}

}  // namespace spherical_springs::mesh
