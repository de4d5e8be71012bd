/** The studio. */
import "../styles/index.css";
