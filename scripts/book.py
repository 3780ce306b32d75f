"""Additions to the book's pages: the project's addresses, and a search that works without a web server."""

import json
import tomllib
from pathlib import Path

SEARCH = "search/index.js"


def on_config(config):
    """Adds the addresses in crates/Cargo.toml to the header and the footer."""
    cargo = Path(config.config_file_path).with_name("crates") / "Cargo.toml"
    package = tomllib.loads(cargo.read_text())["workspace"]["package"]
    homepage, repository = package["homepage"], package["repository"]
    config.repo_url = repository
    links = [(homepage, "The page"), (repository and f"{repository}/issues", "Report a bug")]
    config.copyright = " · ".join(f'<a href="{url}">{label}</a>' for url, label in links if url)
    return config


def on_post_page(output, page, config):
    """Loads the search before the theme's script, which would fetch it: a page from a file cannot fetch files."""
    before, bundle, after = output.rpartition('<script src="assets/javascripts/bundle')
    return f'{before}<script src="{SEARCH}"></script>{bundle}{after}'


def on_post_build(config):
    """Writes the search index and the worker's program as one script."""
    site = Path(config.site_dir)
    index = (site / "search/search_index.json").read_text()
    [worker] = site.glob("assets/javascripts/workers/search.*.min.js")
    (site / SEARCH).write_text(
        f"var __search = {{ index: Promise.resolve({index}), worker: URL.createObjectURL(new Blob([{json.dumps(worker.read_text())}])) }};\n"
    )
