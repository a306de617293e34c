#pragma once

// Numbers of the library as arrays of numpy that hold them, without a copy, and that nobody can change.

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

namespace retrace::python {
namespace py = pybind11;

/// \param shape as many numbers as there are
template <class Number, class Item>
py::array_t<Number> array_of(std::vector<Item>&& items, const std::vector<py::ssize_t>& shape) {
  static_assert(sizeof(Item) % sizeof(Number) == 0 && alignof(Item) == alignof(Number));
  auto held = std::make_unique<std::vector<Item>>(std::move(items));
  const auto* const first = reinterpret_cast<const Number*>(held->data());
  const py::capsule owner(held.get(), [](void* vector) { delete static_cast<std::vector<Item>*>(vector); });
  held.release();
  py::array_t<Number> array(shape, first, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace retrace::python
