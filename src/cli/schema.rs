//! `straylight schema`: the grammar of a system file.

use super::{Ending, tell};
use straylight::error::Error;

/// Prints it.
pub fn schema() -> Result<Ending, Error> {
    tell(straylight::system::schema::SCHEMA);
    Ok(Ending::Done)
}
