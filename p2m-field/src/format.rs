//! The file formats of distance fields.

p2m_core::formats! {
    /// The file formats of distance fields, which [`write_field`](crate::write_field) describes.
    FieldFormat {
        /// This is an array of NumPy.
        Npy = "npy",
        /// This is an image of VTK.
        Vti = "vti",
        /// This has the values alone, without a header.
        Raw = "raw",
    }
}
