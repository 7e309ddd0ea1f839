//! A file is there as a whole or not at all: written beside its place, flushed to the disk, then renamed.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Calls `content` with a writer and puts what it wrote at `path`. On any failure `path` is as it was before.
pub fn create(path: &Path, content: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let draft = builder().tempfile_in(folder)?;
    let mut out = BufWriter::with_capacity(1 << 16, draft.as_file());
    content(&mut out)?;
    out.flush()?;
    drop(out);
    draft.as_file().sync_all()?;
    draft.persist(path).map_err(|failure| failure.error)?;
    Ok(())
}

/// Makes the renames in `folder` durable. Not every file system can; then the files are still whole.
pub fn settle(folder: &Path) {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}

/// A temporary file is private by default; a result is as readable as the user's umask says.
fn builder() -> tempfile::Builder<'static, 'static> {
    #[allow(unused_mut)] // only unix sets permissions
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.prefix(".straylight-");
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_litter() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        create(&path, |out| out.write_all(b"old")).unwrap();
        let failed = create(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
