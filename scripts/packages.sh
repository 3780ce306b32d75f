# Sourced by the set-up scripts: Debian packages, installed if they are missing.

say() { printf 'setup: %s\n' "$*"; }
has() { [ "$(dpkg-query -W -f='${Status}' "$1" 2>/dev/null)" = 'install ok installed' ]; }

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"
    elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then sudo "$@"
    else
        say "these Debian packages are missing and I may not install them. As root, run:"
        printf '    apt-get install -y %s\n' "${missing[*]}"
        exit 1
    fi
}

install_missing() {
    missing=()
    local package
    for package in "$@"; do has "$package" || missing+=("$package"); done
    [ ${#missing[@]} -eq 0 ] && return
    command -v apt-get >/dev/null || { say "not a Debian machine: install the likes of ${missing[*]} yourself, then run this again"; exit 1; }
    say "installing Debian packages: ${missing[*]}"
    as_root apt-get update -q
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
}
