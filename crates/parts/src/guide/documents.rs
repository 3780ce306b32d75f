//! The documents that `lizard parts` writes in addition to the files of the parts: bill of materials and guide.

use lizard_kinematics::Solution;

use crate::bill::Bill;
use crate::bodies::assembly::Assembly;
use crate::build_error::BuildError;
use crate::files::OutputFile;
use crate::guide::make_guide;
use crate::guide::placements::format_placements;

/// Makes bill.json and the folder guide/ with pictures at `pose`, usually neutral.
///
/// # Errors
/// Returns [`BuildError::Blocked`] if a screw cannot be reached.
///
/// # Panics
/// Never: texts and numbers can always be converted to JSON.
pub fn make_documents(
    assembly: &Assembly,
    bill: &Bill,
    pose: &Solution,
) -> Result<Vec<OutputFile>, BuildError> {
    let bill_json =
        serde_json::to_string_pretty(bill).expect("texts and numbers can be converted to JSON");
    let mut files = vec![OutputFile::from_text("bill.json", bill_json + "\n")];
    files.extend(make_guide(assembly, bill, pose)?);
    let placements = format_placements(assembly, pose);
    files.push(OutputFile::from_text("guide/placements.json", placements));
    Ok(files)
}
