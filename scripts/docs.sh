#!/usr/bin/env bash
# Makes pages of the book of docs/ by mdBook, with its pictures and the documents that it links to: target/book/pages/index.html.
# mdBook is installed into target/ where it is not there.
set -euo pipefail
cd "$(dirname "$0")/.."

version=0.4.52
tools=$PWD/target/mdbook
source=target/book/source
pages=target/book/pages

# What stands beside docs/ and is linked to from there.
beside=(README.md CONTRIBUTING.md CHANGELOG.md CITATION.cff LICENSE-APACHE LICENSE-MIT LICENSE-JOE-KUO
    benches/README.md benches/records python/README.md python/names.md python/tutorial.ipynb studies systems)

if ! [ "$("$tools/bin/mdbook" --version 2>/dev/null)" = "mdbook v$version" ]; then
    # Without its server, and quickly built, as it runs for a second.
    cargo install --quiet --locked --debug --no-default-features --features search --version "$version" --root "$tools" mdbook
fi

# mdBook takes pages from below one folder alone: the documents are put there as they lie in the repository, so that links hold.
rm -rf "$source" "$pages"
mkdir -p "$source"
cp -R docs "$source"
for name in "${beside[@]}"; do
    mkdir -p "$source/$(dirname "$name")"
    cp -R "$name" "$source/$name"
done
{
    sed 's|](|](docs/|' docs/SUMMARY.md
    printf '\n# Beside the book\n\n'
    printf -- '- [%s](%s)\n' "The program" README.md "Working on it" CONTRIBUTING.md Changes CHANGELOG.md \
        "A short tour of Python" python/README.md "Names in Python" python/names.md \
        Studies studies/README.md Systems systems/README.md "Measurements of the integrator" benches/README.md
    for record in benches/records/*.md; do
        printf '  - [%s](%s)\n' "$(basename "$record" .md)" "$record"
    done
} >"$source/SUMMARY.md"
sed 's|^src = .*|src = "."|; s|^build-dir = .*|build-dir = "../pages"|' book.toml >"$source/book.toml"
"$tools/bin/mdbook" build "$source"
# Links say README.html, where mdBook has index.html.
find "$pages" -name index.html -execdir cp index.html README.html \;
rm -f "$pages/book.toml"
echo "$pages/docs/index.html"
