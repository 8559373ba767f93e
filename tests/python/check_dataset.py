"""Opens a result with every usual reader and compares it with what was meant to be written."""

import json
import sys

import h5py
import netCDF4
import numpy as np
import xarray

path, expected_path = sys.argv[1:]
with open(expected_path, encoding="utf-8") as file:
    expected = json.load(file)


def wanted(about):
    kind = np.float64 if about["kind"] == "real" else np.int64
    return np.array([kind(text) for text in about["values"]], dtype=kind).reshape(about["shape"])


def check(reader, name, what, found, right):
    if not found == right:
        sys.exit(f"{reader}: {what} of {name} is {found!r}, not {right!r}")


def check_names(reader, name, about, values, attributes):
    """A category whose values are stored by their names."""
    words = [value.decode() if isinstance(value, bytes) else value for value in values]
    names = {code: word for code, word in about["flags"]}
    check(reader, name, "names", words, [names[int(code)] for code in about["values"]])
    check(reader, name, "flag meanings", attributes["flag_meanings"].split(), list(names.values()))


def check_variable(reader, name, about, dimensions, values, attributes):
    check(reader, name, "dimensions", list(dimensions), about["dimensions"])
    for key in ("units", "long_name"):
        check(reader, name, key, attributes.get(key), about[key])
    values = np.asarray(values)
    if name == "direction":
        check_names(reader, name, about, values, attributes)
        return
    right = wanted(about)
    if name == "period" and values.dtype.kind == "f":
        # Where there is none, xarray has it as missing.
        check(reader, name, "missing", np.array_equal(np.isnan(values), right == 0), True)
        values = np.where(np.isnan(values), 0, values).astype(np.int64)
    check(reader, name, "kind", values.dtype.kind, "f" if about["kind"] == "real" else "i")
    check(reader, name, "shape", list(values.shape), about["shape"])
    if right.dtype.kind == "f":
        same = np.array_equal(values, right, equal_nan=True)
    else:
        same = np.array_equal(values.astype(np.int64), right)
    check(reader, name, "equality", same, True)
    if about["flags"]:
        flags = np.atleast_1d(attributes["flag_values"])
        check(reader, name, "flag type", flags.dtype, values.dtype)
        check(reader, name, "flag values", flags.tolist(), [pair[0] for pair in about["flags"]])
        meanings = attributes["flag_meanings"].split()
        check(reader, name, "flag meanings", meanings, [pair[1] for pair in about["flags"]])


def check_globals(reader, attributes):
    check(reader, "file", "Conventions", attributes["Conventions"], "CF-1.11")
    for key, words in expected["attributes"].items():
        found = attributes[key]
        if not isinstance(found, str):
            # A number of the protocol.
            check(reader, "file", f"beginning of {key}", key.startswith("protocol_"), True)
            found, words = float(found), float(words)
        check(reader, "file", key, found, words)


def with_h5py():
    with h5py.File(path, "r") as file:
        check_globals("h5py", file.attrs)
        for name, about in expected["variables"].items():
            array = file[name]
            axes = [axis[0].name.lstrip("/") for axis in array.dims if len(axis)]
            if name in expected["coordinates"]:
                check("h5py", name, "being a scale", array.is_scale, True)
                axes = [name]
            check_variable("h5py", name, about, axes, array[()], array.attrs)
        for name, text in expected["texts"].items():
            check("h5py", name, "text", file[name].asstr()[()], text)


def with_netcdf4():
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        check_globals("netCDF4", {key: file.getncattr(key) for key in file.ncattrs()})
        check("netCDF4", "file", "dimensions", list(file.dimensions), expected["coordinates"])
        for name, about in expected["variables"].items():
            array = file[name]
            attributes = {key: array.getncattr(key) for key in array.ncattrs()}
            check_variable("netCDF4", name, about, array.dimensions, array[...], attributes)
        for name, text in expected["texts"].items():
            check("netCDF4", name, "text", file[name][...], text)


def with_xarray(engine):
    reader = f"xarray with {engine}"
    with xarray.open_dataset(path, engine=engine) as file:
        check_globals(reader, file.attrs)
        # What is the same for all cases is a coordinate, too, so that it is not spread over them.
        constants = {name for name, about in expected["variables"].items() if not about["shape"]}
        coordinates = set(expected["coordinates"]) | set(expected["auxiliary"]) | constants | set(expected["texts"])
        check(reader, "file", "coordinates", set(file.coords), coordinates)
        names = set(expected["variables"]) | set(expected["texts"])
        check(reader, "file", "variables", set(file.variables), names)
        for name, about in expected["variables"].items():
            array = file[name]
            check_variable(reader, name, about, array.dims, array.values, array.attrs)
        for name, text in expected["texts"].items():
            check(reader, name, "text", str(file[name].values), text)


with_h5py()
with_netcdf4()
with_xarray("h5netcdf")
with_xarray("netcdf4")
print("h5py, netCDF4 and xarray (h5netcdf, netcdf4) agree")
