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

# Another apt may be at work. For its lock on the packages apt-get can wait by itself, for that on the lists it
# cannot. Both are waited for so many seconds.
LOCK_WAIT=${LOCK_WAIT:-900}
update_lists() {
    local answer until=$((SECONDS + LOCK_WAIT)) told=
    while ! answer=$(as_root env LC_ALL=C apt-get update -q 2>&1); do
        if [[ $answer != *"Could not get lock"* || $SECONDS -ge $until ]]; then
            printf '%s\n' "$answer"
            return 1
        fi
        [ -n "$told" ] || say "another program installs packages; waiting for it, up to $LOCK_WAIT s"
        told=yes
        sleep 2
    done
}

install_missing() {
    missing=()
    local package
    for package in "$@"; do has "$package" || missing+=("$package"); done
    [ ${#missing[@]} -eq 0 ] && return
    command -v apt-get >/dev/null || { say "not a Debian machine: install the likes of ${missing[*]} yourself, then run this again"; exit 1; }
    say "installing Debian packages: ${missing[*]}"
    update_lists
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout="$LOCK_WAIT" install -y -q --no-install-recommends "${missing[@]}"
}
