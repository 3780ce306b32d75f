//! The crates of the workspace, as its manifest lists them.

use lizard_host_tests::read_file;

/// Lists the folders of all crates, relative to the root of the repository.
pub fn list_crates() -> Vec<String> {
    let manifest = read_file("crates/Cargo.toml");
    let members = manifest.split_once("\nmembers = [");
    let members = members.and_then(|(_, members)| members.split_once(']'));
    let (members, _) = members.expect("the manifest lists its members");
    let folders = members.split('"').skip(1).step_by(2);
    let folders = folders.map(|folder| match folder.strip_prefix("../") {
        Some(path) => path.to_owned(),
        None => format!("crates/{folder}"),
    });
    folders.collect()
}
