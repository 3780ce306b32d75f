"""The project's addresses, which crates/Cargo.toml has, at the head and the foot of the book."""

import tomllib
from pathlib import Path


def on_config(config):
    cargo = Path(config.config_file_path).with_name("crates") / "Cargo.toml"
    package = tomllib.loads(cargo.read_text())["workspace"]["package"]
    page, source = package["homepage"], package["repository"]
    config.repo_url = source
    links = [(page, "The page"), (source and f"{source}/issues", "Report a fault")]
    config.copyright = " · ".join(f'<a href="{to}">{name}</a>' for to, name in links if to)
    return config
