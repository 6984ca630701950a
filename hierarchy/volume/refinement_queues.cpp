#include "hierarchy/volume/refinement_queues.h"

#include <limits>

namespace terrane::hierarchy::volume {

void RefinementQueues::Queue::set(std::uint32_t id, double new_key) {
  if (id >= key.size()) key.resize(id + 1, std::numeric_limits<double>::quiet_NaN());
  if (key[id] == new_key) return;  // its entry is still in the heap
  key[id] = new_key;
  heap.push({new_key, id});
}

void RefinementQueues::Queue::forget(std::uint32_t id) {
  if (id < key.size()) key[id] = std::numeric_limits<double>::quiet_NaN();
}

std::optional<RefinementQueues::Entry> RefinementQueues::Queue::top() {
  // an entry holds as long as its key is the one that was said last (NaN equals nothing)
  while (!heap.empty() && heap.top().key != key[heap.top().id]) heap.pop();
  if (heap.empty()) return {};
  return heap.top();
}

void RefinementQueues::want_split(CellId leaf, double priority) {
  splits_.set(static_cast<std::uint32_t>(leaf), priority);
}

void RefinementQueues::forget(CellId cell) { splits_.forget(static_cast<std::uint32_t>(cell)); }

void RefinementQueues::allow_merge(NodeId middle, double worth) {
  merges_.set(static_cast<std::uint32_t>(middle), -worth);
}

void RefinementQueues::forget(NodeId middle) { merges_.forget(static_cast<std::uint32_t>(middle)); }

std::optional<RefinementQueues::Split> RefinementQueues::worst() {
  const auto top = splits_.top();
  if (!top) return {};
  return Split{CellId{top->id}, top->key};
}

std::optional<RefinementQueues::Merge> RefinementQueues::least() {
  const auto top = merges_.top();
  if (!top) return {};
  return Merge{NodeId{top->id}, -top->key};
}

}  // namespace terrane::hierarchy::volume
