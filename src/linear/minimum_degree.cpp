#include "linear/minimum_degree.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace spherical_springs::core {
namespace {

using Nodes = std::vector<std::uint32_t>;

constexpr std::uint32_t kNone = ~0u;

/// Eliminates nodes one by one. A node that has been eliminated is an element: its members are what
/// is left of its neighbours and of those of its children, and have all become neighbours.
class Elimination {
 public:
  Elimination(const Graph& graph, const Checkpoint& checkpoint)
      : checkpoint_(checkpoint), nodes_(graph.size()) {
    const double many = std::max(16., 10 * std::sqrt(static_cast<double>(graph.size())));
    const auto isDense = [&](std::uint32_t i) {
      return graph.first[i + 1] - graph.first[i] > many;
    };
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
      if (isDense(i)) {
        dense_.push_back(i);
        continue;
      }
      for (std::uint32_t e = graph.first[i]; e < graph.first[i + 1]; ++e) {
        const std::uint32_t j = graph.neighbours[e];
        if (j != i && !isDense(j)) nodes_[i].neighbours.push_back(j);
      }
      propose(i, nodes_[i].neighbours.size());
    }
  }

  void run() {
    while (!queue_.empty()) {
      const auto [degree, i] = queue_.top();
      queue_.pop();
      if (degree != nodes_[i].degree || nodes_[i].eliminated) continue;
      checkpoint_();
      eliminate(i);
    }
  }

  struct Node {
    Nodes neighbours;  // but for those by way of an element
    Nodes elements;    // of which it is a member; of an element, its children
    Nodes members;     // of an element that has no parent yet
    bool eliminated = false;
    std::size_t degree = 0;    // about
    std::size_t outside = 0;   // members of an element that are not members of the last one
    std::size_t boundary = 0;  // members that an element had at first
    std::uint32_t seen = 0;    // the last elimination that has met it
    std::uint32_t parent = kNone;
  };
  const std::vector<Node>& nodes() const { return nodes_; }
  const Nodes& order() const { return order_; }
  const Nodes& dense() const { return dense_; }

 private:
  /// Whether a node is met for the first time in the elimination under way.
  bool meet(std::uint32_t i) {
    return std::exchange(nodes_[i].seen, order_.size()) != order_.size();
  }

  void propose(std::uint32_t i, std::size_t degree) {
    nodes_[i].degree = degree;
    queue_.emplace(degree, i);
  }

  void eliminate(std::uint32_t pivot) {
    order_.push_back(pivot);
    meet(pivot);
    Node& element = nodes_[pivot];
    element.eliminated = true;
    const auto addMembers = [&](Nodes& some) {
      for (const std::uint32_t i : some) {
        if (meet(i)) element.members.push_back(i);
      }
      Nodes().swap(some);
    };
    addMembers(element.neighbours);
    for (const std::uint32_t child : element.elements) {
      addMembers(nodes_[child].members);
      nodes_[child].parent = pivot;
    }
    element.boundary = element.members.size();
    for (const std::uint32_t i : element.members) forget(nodes_[i]);
    for (const std::uint32_t i : element.members) join(i, pivot);
  }

  /// Takes off a member's lists what it has by way of the last element from now on, and the member
  /// off the count of those in other elements alone.
  void forget(Node& member) {
    const auto drop = [](Nodes& list, const auto& doomed) {
      list.erase(std::remove_if(list.begin(), list.end(), doomed), list.end());
    };
    drop(member.neighbours, [&](std::uint32_t j) { return nodes_[j].seen == order_.size(); });
    drop(member.elements, [&](std::uint32_t e) { return nodes_[e].parent != kNone; });
    for (const std::uint32_t e : member.elements) {
      if (meet(e)) nodes_[e].outside = nodes_[e].members.size();
      --nodes_[e].outside;
    }
  }

  void join(std::uint32_t i, std::uint32_t element) {
    Node& node = nodes_[i];
    std::size_t degree = node.neighbours.size() + nodes_[element].members.size() - 1;
    for (const std::uint32_t e : node.elements) degree += nodes_[e].outside;
    node.elements.push_back(element);
    propose(i, degree);
  }

  const Checkpoint& checkpoint_;
  std::vector<Node> nodes_;
  Nodes order_, dense_;
  using Proposal = std::pair<std::size_t, std::uint32_t>;  // degree and node
  std::priority_queue<Proposal, std::vector<Proposal>, std::greater<>> queue_;
};

/// Puts each node into the group of its parent while no column of the group's front gets more than
/// a few zeros, and roots into groups of their own under that of the dense nodes.
std::vector<EliminationGroup> grouped(const Elimination& elimination) {
  constexpr std::size_t kZeros = 12;
  std::vector<EliminationGroup> groups = {{elimination.dense(), {}}};
  Nodes group_of(elimination.nodes().size());
  std::vector<std::size_t> boundary = {0};  // of each group
  std::uint32_t last_root = kNone;
  for (auto i = elimination.order().rbegin(); i != elimination.order().rend(); ++i) {
    const Elimination::Node& node = elimination.nodes()[*i];
    const bool root = node.parent == kNone;
    std::uint32_t group = root ? last_root : group_of[node.parent];
    if (group == kNone || groups[group].nodes.size() + boundary[group] > node.boundary + kZeros) {
      groups[root ? 0 : group].children.push_back(static_cast<std::uint32_t>(groups.size()));
      group = static_cast<std::uint32_t>(groups.size());
      groups.emplace_back();
      boundary.push_back(node.boundary);
      if (root) last_root = group;
    }
    group_of[*i] = group;
    groups[group].nodes.push_back(*i);
  }
  for (EliminationGroup& group : groups) std::reverse(group.nodes.begin(), group.nodes.end());
  return groups;
}

/// `groups`: the root first.
std::vector<EliminationGroup> inPostorder(const std::vector<EliminationGroup>& groups) {
  Nodes preorder, stack = {0}, places(groups.size());
  while (!stack.empty()) {
    const std::uint32_t group = stack.back();
    stack.pop_back();
    places[group] = static_cast<std::uint32_t>(groups.size() - 1 - preorder.size());
    preorder.push_back(group);
    stack.insert(stack.end(), groups[group].children.begin(), groups[group].children.end());
  }
  std::vector<EliminationGroup> result(groups.size());
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    result[places[g]].nodes = groups[g].nodes;
    for (const std::uint32_t child : groups[g].children) {
      result[places[g]].children.push_back(places[child]);
    }
  }
  return result;
}

}  // namespace

std::vector<EliminationGroup> minimumDegree(const Graph& graph, const Checkpoint& checkpoint) {
  Elimination elimination(graph, checkpoint);
  elimination.run();
  return inPostorder(grouped(elimination));
}

}  // namespace spherical_springs::core
