/*! three.js r111, https://github.com/mrdoob/three.js, MIT licence, copyright 2010-2019 three.js authors */
