# shellcheck shell=bash
# Shared by the scripts beside it; source it. Leaves the shell in the repository's root.
set -euo pipefail
script=$(realpath "$0")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '\n== %s\n' "$*"; }

# die STATUS SENTENCE: 2 is wrong usage, 3 is a machine that lacks something.
die() {
    printf '%s: %s\n' "$(basename "$script")" "$2" >&2
    exit "$1"
}

# Prints the comment at the top of the calling script as its help.
usage() { awk 'NR > 1 { if (!/^#/ || /^# shellcheck/) exit; sub(/^# ?/, ""); print }' "$script"; }

# Debian packages of scripts/packages.txt, one a line.
packages() { grep -v '^#' scripts/packages.txt; }

# take_options ARGUMENT...: sorts the arguments that scripts/build, test and bench have in common into setup_options,
# preset and definitions; leaves the others in `rest`.
# shellcheck disable=SC2034
take_options() {
    setup_options=() preset=release definitions=() rest=()
    while (($#)); do
        case $1 in
            --with-cuda | --without-exr) setup_options+=("$1") ;;
            --preset)
                (($# > 1)) || die 2 "--preset needs a name; cmake --list-presets has them"
                preset=$2
                shift
                ;;
            -D?*) definitions+=("$1") ;;
            -h | --help) usage && exit ;;
            *) rest+=("$1") ;;
        esac
        shift
    done
}
