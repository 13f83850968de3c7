//! The formats of distance fields in files.

p2m_mixed::formats! {
    /// The formats of distance fields, see [`write_field`](crate::write_field).
    FieldFormat {
        /// An array of NumPy.
        Npy = "npy",
        /// An image of VTK.
        Vti = "vti",
        /// The values alone.
        Raw = "raw",
    }
}
