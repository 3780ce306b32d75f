# Functions of the set-up scripts that install missing Debian packages and Python packages.

say() { printf 'setup: %s\n' "$*"; }
# A package may be on hold, or installed for several architectures.
is_installed() { [[ $(dpkg-query -W -f='${Status}' "$1" 2>/dev/null) == *' ok installed'* ]]; }

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"
    elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then sudo "$@"
    else
        say "Debian packages are missing, and installing them requires root. As root, run:"
        printf '    apt-get install -y %s\n' "${missing[*]}"
        exit 1
    fi
}

# The longest wait for another apt, s. apt-get itself can wait for the lock on the packages, but not for the lock on the
# lists.
LOCK_WAIT=${LOCK_WAIT:-900}
update_lists() {
    local output until=$((SECONDS + LOCK_WAIT)) has_reported=
    while ! output=$(as_root env LC_ALL=C apt-get update -q 2>&1); do
        if [[ $output != *"Could not get lock"* || $SECONDS -ge $until ]]; then
            printf '%s\n' "$output"
            return 1
        fi
        [ -n "$has_reported" ] || say "another program is installing packages; waiting up to $LOCK_WAIT s"
        has_reported=yes
        sleep 2
    done
}

run_apt_install() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout="$LOCK_WAIT" install -y -q --no-install-recommends "${missing[@]}"
}

install_missing() {
    missing=()
    local package
    for package in "$@"; do is_installed "$package" || missing+=("$package"); done
    [ ${#missing[@]} -eq 0 ] && return
    command -v apt-get >/dev/null || { say "not a Debian machine: install the equivalents of ${missing[*]}, then run this again"; exit 1; }
    say "installing Debian packages: ${missing[*]}"
    update_lists
    # After a set-up that was killed, apt-get does nothing until dpkg has configured what was half installed.
    run_apt_install || { as_root env DEBIAN_FRONTEND=noninteractive dpkg --configure -a && run_apt_install; }
}

# Creates a virtual environment with Python packages, unless it is complete: its file `installed` is written last.
install_venv() { # folder, file of requirements, description, modules to import
    cmp -s "$2" "$1/installed" && "$1/bin/python" -c "import $4" 2>/dev/null && return
    command -v python3 >/dev/null || install_missing python3
    # In Debian, the part of Python that creates virtual environments is a separate package.
    python3 -c 'import ensurepip' 2>/dev/null || install_missing python3-venv
    say "installing $3 into $1"
    rm -rf "$1"
    python3 -m venv "$1"
    "$1/bin/python" -m pip install -q --disable-pip-version-check -r "$2"
    "$1/bin/python" -c "import $4" || { say "after the installation into $1, Python cannot import $4"; exit 1; }
    cp "$2" "$1/installed"
}
