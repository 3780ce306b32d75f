"""Additions to the book's pages: the project's addresses, and a search that works from a file."""

import json
import tomllib
from pathlib import Path

SEARCH = "search/index.js"


def on_config(config):
    """Shows the addresses of crates/Cargo.toml at the head and the foot."""
    cargo = Path(config.config_file_path).with_name("crates") / "Cargo.toml"
    package = tomllib.loads(cargo.read_text())["workspace"]["package"]
    page, source = package["homepage"], package["repository"]
    config.repo_url = source
    links = [(page, "The page"), (source and f"{source}/issues", "Report a fault")]
    config.copyright = " · ".join(f'<a href="{to}">{name}</a>' for to, name in links if to)
    return config


def on_post_page(output, page, config):
    """Loads the search before the theme's program, which would fetch it: from a file, a browser fetches nothing."""
    before, bundle, after = output.rpartition('<script src="assets/javascripts/bundle')
    return f'{before}<script src="{SEARCH}"></script>{bundle}{after}'


def on_post_build(config):
    """Writes the search's index, and its worker's program, as a script."""
    site = Path(config.site_dir)
    index = (site / "search/search_index.json").read_text()
    [worker] = site.glob("assets/javascripts/workers/search.*.min.js")
    (site / SEARCH).write_text(
        f"var __search = {{ index: Promise.resolve({index}), worker: URL.createObjectURL(new Blob([{json.dumps(worker.read_text())}])) }};\n"
    )
