//! The documents of `lizard parts` besides the files of the parts: bill and guide.

use lizard_kinematics::Solution;

use crate::bill::Bill;
use crate::bodies::assembly::Assembly;
use crate::build_problem::BuildProblem;
use crate::files::File;
use crate::guide::guide;
use crate::guide::placements::placements;

/// Makes bill.json and the folder guide/, with pictures at a pose, usually neutral.
///
/// # Errors
/// Returns [`BuildProblem::Blocked`] for a screw that cannot be reached.
///
/// # Panics
/// Never: texts and numbers can always be written as JSON.
pub fn documents(
    assembly: &Assembly,
    bill: &Bill,
    pose: &Solution,
) -> Result<Vec<File>, BuildProblem> {
    let bill_json =
        serde_json::to_string_pretty(bill).expect("texts and numbers can be written as JSON");
    let mut files = vec![File::text("bill.json".to_owned(), bill_json + "\n")];
    files.extend(guide(assembly, bill, pose)?);
    files.push(File::text(
        "guide/placements.json".to_owned(),
        placements(assembly, pose),
    ));
    Ok(files)
}
