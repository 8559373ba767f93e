#!/bin/sh
# Installs what a machine lacks to build capsulemap: a C compiler, pkg-config and the HDF5 library.
# Does nothing, silently, when all is there.
set -eu

has() { command -v "$1" >/dev/null 2>&1; }

has_compiler() { has cc || has gcc || has clang; }

# Where the build looks: a folder given by hand, pkg-config (Debian), the system's headers (Fedora),
# Homebrew.
has_hdf5() {
    [ -n "${HDF5_DIR:-}" ] ||
        { has pkg-config && pkg-config --exists hdf5; } ||
        [ -e /usr/include/hdf5.h ] ||
        { has brew && [ -e "$(brew --prefix)/include/hdf5.h" ]; }
}

complete() { has_compiler && has_hdf5; }

give_up() {
    echo "setup: $1" >&2
    echo "setup: install a C compiler, pkg-config and the HDF5 library with its headers:" >&2
    echo "  Debian, Ubuntu:  apt-get install gcc libc6-dev pkg-config libhdf5-dev" >&2
    echo "  Fedora:          dnf install gcc pkgconf-pkg-config hdf5-devel" >&2
    echo "  macOS:           xcode-select --install; brew install pkg-config hdf5" >&2
    echo "or set HDF5_DIR to a folder that has HDF5's lib and include." >&2
    exit 1
}

# Runs a command as root, through sudo if need be; without a terminal sudo must not ask.
as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif [ -t 0 ]; then
        sudo "$@"
    else
        sudo -n "$@"
    fi
}

need_root() {
    [ "$(id -u)" -eq 0 ] || has sudo || give_up "to install needs root, and there is no sudo"
}

apt_install() {
    set -- "$@" pkg-config libhdf5-dev
    has_compiler || set -- "$@" gcc libc6-dev
    # A machine may never have fetched the lists of packages, or have old ones: try, fetch, try.
    apt_try "$@" >/dev/null 2>&1 || { as_root apt-get update -q && apt_try "$@"; }
}

apt_try() {
    as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -q --no-install-recommends "$@"
}

install_missing() {
    if has apt-get; then
        need_root
        apt_install
    elif has dnf; then
        need_root
        # RHEL and its kin keep HDF5 in the EPEL repository; Fedora has it at hand.
        as_root dnf install -y gcc pkgconf-pkg-config hdf5-devel
    elif has brew; then
        brew install pkg-config hdf5
    else
        give_up "none of apt-get, dnf and brew is here"
    fi
}

if ! has cargo; then
    echo "setup: Rust is missing: see https://rustup.rs, or run" >&2
    echo "  curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh" >&2
    echo "and open a new shell, so that 'cargo' is found." >&2
    exit 1
fi

complete && exit 0
echo "setup: installing what is missing to build with HDF5" >&2
install_missing >&2 || give_up "the installation failed"
complete || give_up "after the installation something is still missing"
