// The kernels as a Python module: this folder is all that knows of Python.  All of them release the GIL.
#include "modules.hpp"

#include "../errors.hpp"
#include "../instructions.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

void translate_errors(const std::exception_ptr& error, void*) {
    const auto raise = [](const char* name, const char* message) {
        const nb::object type = nb::module_::import_("ebz.codec.errors").attr(name);
        PyErr_SetString(type.ptr(), message);
    };
    try {
        std::rethrow_exception(error);
    } catch (const ebz::Corrupt& e) {
        raise("CorruptError", e.what());
    } catch (const ebz::TooLarge& e) {
        raise("MeshError", e.what());
    }
}

}  // namespace

NB_MODULE(_kernels, m) {
    m.doc() = "The loops of ebz, in C++; arguments are checked by the modules that call them.";
    nb::register_exception_translator(translate_errors);
    m.def("forbid_extensions", &ebz::forbid_extensions, "forbidden"_a,
          "Take the baseline instructions on every machine, or no more; for tests.");
    ebz::binding::bind_word(m);
    ebz::binding::bind_polygons(m);
    ebz::binding::bind_sites(m);
    ebz::binding::bind_positions(m);
    ebz::binding::bind_lattices(m);
    ebz::binding::bind_attributes(m);
    ebz::binding::bind_elements(m);
    ebz::binding::bind_orders(m);
    ebz::binding::bind_streams(m);
}
