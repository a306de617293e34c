#pragma once

// Converts vectors of the library to read-only numpy arrays without copying. Each array owns its data.

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

namespace retrace::python {
namespace py = pybind11;

/// \param shape shape of the array; its product is the number of values in `items`
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
