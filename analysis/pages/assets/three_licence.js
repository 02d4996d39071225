/*! three.js, https://github.com/mrdoob/three.js, MIT licence, copyright 2010 three.js authors */
