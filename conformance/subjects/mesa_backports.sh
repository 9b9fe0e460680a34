#!/usr/bin/env bash
# mesa_backports.sh FOLDER: a newer Mesa as one more subject, beside the system's and without touching it.
#
# Downloads mesa-vulkan-drivers from Debian's backports, with those of its dependencies that the system lacks or has too
# old, through apt but with sources, lists and cache of its own; unpacks them into FOLDER, installs nothing, needs no root;
# and writes FOLDER/lvp_icd.json, for `./edgecase run --subject vulkan:FOLDER/lvp_icd.json`. Exit status 2 if it cannot.
# EDGECASE_DEBIAN_MIRROR names another mirror than deb.debian.org.
set -euo pipefail

say() { printf 'edgecase: %s\n' "$*" >&2; }
fail() { say "$1"; exit 2; }

mkdir -p "$1" || exit 2
folder=$(cd -- "$1" && pwd)
log=$folder/log
mirror=${EDGECASE_DEBIAN_MIRROR:-http://deb.debian.org/debian}
keyring=/usr/share/keyrings/debian-archive-keyring.gpg

command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || fail "no apt-get: Debian's backports cannot be had"
[ -r "$keyring" ] || fail "no $keyring, with which Debian signs its packages"
release=$(. /etc/os-release && printf '%s' "${VERSION_CODENAME:-}")
[ -n "$release" ] || fail "no VERSION_CODENAME in /etc/os-release: which release's backports?"
command -v cc >/dev/null || fail "no C compiler, cc"

rm -rf "$folder/root" "$folder/apt"
mkdir -p "$folder/root" "$folder/apt/lists/partial" "$folder/apt/archives/partial"
for suite in "$release" "$release-backports"; do
  printf 'deb [signed-by=%s] %s %s main\n' "$keyring" "$mirror" "$suite"
done >"$folder/apt/sources.list"

# Everything of apt's that could be written lies in the folder; what is installed is only read, hence no lock.
apt() {
  apt-get -q -o Dir::Etc::sourcelist="$folder/apt/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o Dir::State::lists="$folder/apt/lists" -o Dir::Cache="$folder/apt" -o Debug::NoLocking=1 \
    -o APT::Sandbox::User= -o Acquire::Retries=1 -o Acquire::http::Timeout=20 -o APT::Update::Error-Mode=any "$@" \
    >>"$log" 2>&1 </dev/null
}
: >"$log"
apt update || fail "$mirror cannot be reached, or has no $release-backports; $log tells more"
apt install -y --no-install-recommends --download-only --reinstall -t "$release-backports" mesa-vulkan-drivers ||
  fail "mesa-vulkan-drivers of $release-backports cannot be downloaded; $log tells more"

for package in "$folder"/apt/archives/*.deb; do
  dpkg-deb -x "$package" "$folder/root" || fail "$package cannot be unpacked"
done
driver=$(find "$folder/root" -name libvulkan_lvp.so -print -quit)
[ -n "$driver" ] || fail "no lavapipe, libvulkan_lvp.so, in what was downloaded"

# The driver looks for its libraries where the system keeps its older ones. A library without code that depends on it, and
# has an RPATH, which unlike a RUNPATH holds for what is loaded for its sake, leads it to its own.
library=$folder/liblavapipe.so
cc -shared -o "$library" -x c /dev/null -Wl,--disable-new-dtags,-rpath,"$(dirname "$driver")" -Wl,--no-as-needed \
  -Wl,--allow-shlib-undefined -x none "$driver" >>"$log" 2>&1 || fail "cc made no $library; $log tells more"
api=$(sed -n 's/.*"api_version": *"\([^"]*\)".*/\1/p' "$(find "$folder/root" -path '*icd.d/lvp_icd*' -print -quit)")
printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s", "api_version": "%s"}}\n' "$library" \
  "${api:-1.2.0}" >"$folder/lvp_icd.json"

version=$(dpkg-deb -f "$folder"/apt/archives/mesa-vulkan-drivers_*.deb Version)
say "Mesa $version lies in $folder; compare it with"
printf './edgecase run --subject vulkan:%s\n' "$folder/lvp_icd.json"
