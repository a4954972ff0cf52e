// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/values.h"

#include <utility>

#include "incise/base/error.h"

namespace incise::python {

namespace py = pybind11;

namespace {

std::string text_from(const py::handle& object) {
    py::ssize_t size = 0;
    const char* text = PyUnicode_AsUTF8AndSize(object.ptr(), &size);
    if (!text) throw py::error_already_set();
    return {text, static_cast<std::size_t>(size)};
}

scenario::Value make(decltype(scenario::Value::data) data) { return {std::move(data), {}}; }

scenario::Value convert(const py::handle& object, const std::string& name, int depth) {
    constexpr int deepest = 32;
    if (depth > deepest) throw InputError("'" + name + "' is nested too deeply");
    if (py::isinstance<py::bool_>(object)) return make(object.cast<bool>());
    if (py::isinstance<py::int_>(object)) {
        int overflow = 0;
        const long long value = PyLong_AsLongLongAndOverflow(object.ptr(), &overflow);
        if (overflow != 0) throw InputError("'" + name + "' is a number too large");
        if (value == -1 && PyErr_Occurred()) throw py::error_already_set();
        return make(std::int64_t{value});
    }
    if (py::isinstance<py::float_>(object)) return make(object.cast<double>());
    if (py::isinstance<py::str>(object)) return make(text_from(object));
    if (py::isinstance<py::dict>(object)) {
        scenario::Table table;
        const std::string prefix = name.empty() ? "" : name + ".";
        for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(object)) {
            if (!py::isinstance<py::str>(key))
                throw py::type_error("'" + name + "' has a key that is no text");
            if (entry.is_none()) continue;
            const std::string word = text_from(key);
            table.push_back({word, {}, convert(entry, prefix + word, depth + 1)});
        }
        return make(std::move(table));
    }
    if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
        scenario::Array array;
        // By index, as a conversion may call code of the user that changes the list.
        const auto sequence = py::reinterpret_borrow<py::sequence>(object);
        for (std::size_t i = 0; i < sequence.size(); ++i)
            array.push_back(convert(sequence[i], name + "[" + std::to_string(i) + "]", depth + 1));
        return make(std::move(array));
    }
    if (py::hasattr(object, "tolist"))  // arrays and scalars of numpy
        return convert(object.attr("tolist")(), name, depth + 1);
    if (py::hasattr(object, "__fspath__"))
        return convert(object.attr("__fspath__")(), name, depth + 1);
    throw py::type_error("'" + name + "' is of the type " +
                         std::string(py::str(py::type::of(object).attr("__name__"))) +
                         ": a scenario has numbers, texts, lists and dicts");
}

}  // namespace

scenario::Value value_from(const py::handle& object, const std::string& name) {
    return convert(object, name, 0);
}

py::object object_from(const scenario::Value& value) {
    if (const auto* flag = value.get<bool>()) return py::bool_(*flag);
    if (const auto* integer = value.get<std::int64_t>()) return py::int_(*integer);
    if (const auto* number = value.get<double>()) return py::float_(*number);
    if (const auto* text = value.get<std::string>()) return py::str(*text);
    if (const auto* array = value.get<scenario::Array>()) {
        py::list list;
        for (const scenario::Value& item : *array) list.append(object_from(item));
        return list;
    }
    py::dict dict;
    if (const auto* table = value.get<scenario::Table>())
        for (const scenario::Entry& entry : *table)
            dict[py::str(entry.key)] = object_from(entry.value);
    return dict;
}

}  // namespace incise::python
