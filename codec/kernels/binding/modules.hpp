// What each file of this folder adds to the Python module.
#pragma once

#include <nanobind/nanobind.h>

namespace ebz::binding {

void bind_attributes(nanobind::module_& m);
void bind_elements(nanobind::module_& m);
void bind_lattices(nanobind::module_& m);
void bind_orders(nanobind::module_& m);
void bind_polygons(nanobind::module_& m);
void bind_positions(nanobind::module_& m);
void bind_sites(nanobind::module_& m);
void bind_streams(nanobind::module_& m);
void bind_word(nanobind::module_& m);

}  // namespace ebz::binding
