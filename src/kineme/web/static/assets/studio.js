/* Built from src/kineme/web/pages by npm run build: change it there. */
var e,t,n,r,i,a,o,s,c,l,u,d,f=Symbol.for(`pv`),p={},m=[],h=/^m(i|n|o|s|text|space)$/,g=Array.isArray,_=m.slice,v=Object.assign;function y(e){e&&e.parentNode&&e.remove()}function b(e,t,n){var r,i,a,o={},s=arguments.length;for(a in t)a==`key`?r=t[a]:a==`ref`&&typeof e!=`function`?i=t[a]:o[a]=t[a];return s>2&&(o.children=s>3?_.call(arguments,2):n),x(e,o,r,i,null)}function x(n,r,i,a,o){var s={type:n,props:r,key:i,ref:a,__k:null,__:null,__b:0,__e:null,__c:null,constructor:f,__v:o||++t,__i:-1,__u:0};return!o&&e.vnode&&e.vnode(s),s}function S(e){return e.children}function C(e,t){this.props=e,this.context=t,this.__g=0}function w(e,t){if(t==null)return e.__&&w(e.__,e.__i+1);for(var n;t<e.__k.length;t++)if((n=e.__k[t])&&n.__e)return n.__e;return typeof e.type!=`function`||e.props.__P?null:w(e)}function T(t){var n,r=t.__v,i=r.__e,a=[],o=[],s=t.__P;s&&((n=v({constructor:f},r)).__v=r.__v+1,e.vnode&&e.vnode(n),N(s,n,r,t.__n,s.namespaceURI,32&r.__u?[i]:null,a,i||w(r),32&r.__u,o),n.__v=r.__v,n.__.__k[n.__i]=n,ae(a,n,o),r.__=r.__e=null,n.__e!=i&&E(n))}function E(e){if((e=e.__)&&e.__c&&!e.props.__P)return e.__e=null,e.__k.some(function(t){return t&&(e.__e=t.__e)}),E(e)}function D(t){(8&t.__g||(t.__g|=8,r.push(t),a++))&&i==e.debounceRendering||((i=e.debounceRendering)||queueMicrotask)(O)}function O(){try{for(var e,t=1;r.length;)r.length>t&&r.sort(o),e=r.shift(),t=r.length,8&e.__g&&T(e)}finally{(a=r.length)&&(i||queueMicrotask)(O)}}function k(e,t,n,r,i,a,o,s,c,l,u){var d,f,h,g,_,v,y=r.__k||m,b=t.length;for(c=A(n,t,y,c,b),d=0;d<b;d++)(h=n.__k[d])!=null&&(f=~h.__i&&y[h.__i]||p,h.__i=d,v=N(e,h,f,i,a,o,s,c,l,u),g=h.__e,(f.ref!=h.ref||8&f.__u)&&(f.ref&&se(f.ref,null,h,f),h.ref&&u.push(h.ref,h.__c||g,h)),_||=g,4&h.__u?(c=j(h,c,e,!f.__v),f.__e&&(f.__e=null)):typeof h.type==`function`&&v!==void 0?c=v:g&&(c=g.nextSibling),h.__u&=-21);return n.__e=_,c}function A(e,t,n,r,i){var a,o,s,c,l,u,d,p,m,h=n.length,_=h,v=0,y=0,b=e.__k=Array(i);for(a=0;a<i;a++)(o=t[a])!=null&&typeof o!=`boolean`&&typeof o!=`function`?(typeof o!=`object`||o.constructor===String?o=b[a]=x(null,o):g(o)?o=b[a]=x(S,{children:o}):o.constructor===f&&o.__b?o=b[a]=x(o.type,o.props,o.key,o.ref,o.__v):b[a]=o,c=a+v,o.__=e,o.__b=e.__b+1,s=null,~(l=o.__i=ee(o,n,c,_))&&(_--,(s=n[l])&&(s.__u|=2)),s&&s.__v?(o.__u|=16,l==c-1?v--:l==c+1?v++:l!=c&&(l>c?v--:v++,y=1)):(~l||(i>h?v--:i<h&&v++),typeof o.type!=`function`&&(o.__u|=4))):b[a]=null;if(y){for(u=[],d=[],a=0;a<i;a++)if((o=b[a])&&16&o.__u){for(v=0,p=u.length;v<p;)u[m=v+p>>1]<o.__i?v=m+1:p=m;u[v]=o.__i,d[a]=v+1}for(v=u.length;a--;)d[a]&&(d[a]==v?v--:b[a].__u|=4)}if(_)for(a=0;a<h;a++)!(s=n[a])||2&s.__u||(s.__e==r&&(r=w(s)),ce(s,s));return r}function j(e,t,n,r){var i,a,o,s;if(typeof e.type==`function`){if(e.props.__P)return t;if(i=e.__k)for(a=0;a<i.length;a++)i[a]&&(i[a].__=e,t=j(i[a],t,n,!1));return t}for(t&&!t.parentNode&&(t=w(e))&&!t.parentNode&&(t=null),o=e.__e,s=t;s&&s.nodeType==8;)s=s.nextSibling;for(o!=s&&(!r&&n.moveBefore&&o.parentNode?n.moveBefore(o,t):n.insertBefore(o,t||null)),t=o;(t&&=t.nextSibling)&&t.nodeType==8&&!t.data.startsWith(`$s`););return t}function ee(e,t,n,r){var i,a=e.key,o=e.type,s=t[n],c=s&&!(2&s.__u);if(s===null&&a==null||c&&a==s.key&&o==s.type)return n;if(r>+!!c){for(i=n-1;i>=0;i--)if((s=t[i])&&!(2&s.__u)&&a==s.key&&o==s.type)return i;for(i=n+1;i<t.length;i++)if((s=t[i])&&!(2&s.__u)&&a==s.key&&o==s.type)return i}return-1}function M(e,t,n){n??=``,t[0]==`-`?e.setProperty(t,n):e[t]=n}function te(e,t,n,r,i){var a,o;if(t==`style`){if(typeof n==`string`)e.style.cssText=n;else{if(typeof r==`string`&&(e.style.cssText=r=``),r)for(t in r)n&&t in n||M(e.style,t);if(n)for(t in n)r&&n[t]==r[t]||M(e.style,t,n[t])}}else if(t[0]==`o`&&t[1]==`n`)typeof n!=`function`&&(n=null),typeof r!=`function`&&(r=null),(e.__e||={})[t]=n,n&&r||(o=u[t]||(u[t]=ne(t)),(e.__a||={})[t]=l,a=t!=(t=t.replace(c,`$1`)),(t=t.slice(2))[0]<`a`&&(t=t.toLowerCase()),n?e.addEventListener(t,o,a):e.removeEventListener(t,o,a));else{if(i==`http://www.w3.org/2000/svg`)t=t.replace(/xlink(H|:h)/,`h`).replace(/sName$/,`s`);else if(t!=`width`&&t!=`height`&&t!=`href`&&t!=`list`&&t!=`form`&&t!=`tabIndex`&&t!=`download`&&t!=`rowSpan`&&t!=`colSpan`&&t!=`role`&&t!=`popover`&&t in e)try{e[t]=n??``;return}catch{}if(typeof n==`function`)return;n==null||!1===n&&t[4]!=`-`?e.removeAttribute(t):e.setAttribute(t,t==`popover`&&n==1?``:n)}}function ne(t){return function(n){var r=this.__e;if(r){if(r=r[t],n[s]==null)n[s]=l++;else if(n[s]<this.__a[t])return;return r(e.event?e.event(n):n)}}}function N(t,n,r,i,a,o,s,c,l,u){var d,p,h,_,b,x,T,E,D,O,A,j,ee,M,te,ne,N,ae,se=n.type;if(n.constructor!==f)return null;128&r.__u&&(l=32&r.__u,d=r.__c.__z)&&(n.__u|=l,p=o=[],d.nodeType==8?c=re(d,o):o.push(d),c=o[0]||c),(d=e.__b)&&d(n);n:if(typeof se==`function`){h=s.length;try{if(E=n.props,D=(d=se.prototype)&&d.render,O=(d=se.contextType)&&i[d.__c],A=d?O?O.props.value:d.__:i,(_=r.__c)?(n.__c=_,2&_.__g&&(_.__g|=1)):(D?n.__c=_=new se(E,A):(n.__c=_=new C(E,A),_.constructor=se,_.render=le),O&&O.sub(_),_.state||(_.state={}),_.__n=i,_.__g|=8,_.__h=[],_.__k=[]),D&&(_.__s||(_.__s=_.state),se.getDerivedStateFromProps&&(_.__s==_.state&&(_.__s=v({},_.__s)),v(_.__s,se.getDerivedStateFromProps(E,_.__s)))),b=_.props,x=_.state,_.__v=n,r.__c){if(E!==b&&D&&!se.getDerivedStateFromProps&&_.componentWillReceiveProps&&_.componentWillReceiveProps(E,A),n.__v==r.__v&&!(8&_.__g)||!(4&_.__g)&&_.shouldComponentUpdate&&!1===_.shouldComponentUpdate(E,_.__s,A)){n.__v!=r.__v&&(_.props=E,_.state=_.__s,_.__g&=-9),n.__e=r.__e,n.__k=r.__k,n.__k.some(function(e){e&&(e.__=n)}),m.push.apply(_.__h,_.__k),_.__k=[],_.__h.length&&s.push(_),c=w(r);break n}_.componentWillUpdate&&_.componentWillUpdate(E,_.__s,A),D&&_.componentDidUpdate&&_.__h.push(function(){_.componentDidUpdate(b,x,T)})}else D&&!se.getDerivedStateFromProps&&_.componentWillMount&&_.componentWillMount(),D&&_.componentDidMount&&_.__h.push(_.componentDidMount);_.context=A,_.props=E,_.__P=t,_.__g&=-5,j=e.__r,ee=D?25:0;do _.__g&=-9,j&&j(n),d=_.render(_.props,_.state=_.__s,_.context);while(8&_.__g&&++ee<25);D&&(m.push.apply(_.__h,_.__k),_.__k=[]),_.state=_.__s,_.getChildContext&&(i=v({},i,_.getChildContext())),D&&r.__c&&_.getSnapshotBeforeUpdate&&(T=_.getSnapshotBeforeUpdate(b,x)),M=d&&d.type===S&&d.key==null?d.props.children:d,E.__P&&(d=c,a=(t=E.__P).namespaceURI,l=o=null,r.props&&r.props.__P!=t&&(r.__k.some(function(e){e&&ce(e,e)}),r.__k=null),c=r.__k?w(r,0):null),c=k(t,g(M)?M:[M],n,r,i,a,o,s,c,l,u),E.__P&&(n.__e=null,c=d),n.__u&=-161,p&&p.some(y),_.__h.length&&s.push(_),1&_.__g&&(_.__g&=-4)}catch(t){if(s.length=h,n.__v=null,l||o){if(t&&t.then){if(n.__u|=128|l,o){for(~(N=o.indexOf(c||void 0))||(N=o.length);(ae=o[N-1])&&ae.nodeType==8;)N--;for(;N<o.length;N++)if(ae=o[N]){if(o[N]=null,te){if(ae==ne)break}else{if(ae.nodeType!=8)break;ae.data.startsWith(`$s`)&&(ne=re(te=ae))}}}if(!te){for(;c&&c.nodeType==8&&c.nextSibling;)c=c.nextSibling;te=c}(d=re(te=n.__c.__z||(n.__c.__z=te)))?(n.__e=te,c=d):n.__e=c,c&&=c.nextSibling}else o&&o.some(y)}else n.__e=r.__e;n.__k||=r.__k||[],t&&t.then||ie(n),e.__e(t,n,r)}}else c=n.__e=oe(r.__e,n,r,i,a,o,s,l,u,t);return(d=e.diffed)&&d(n),c}function re(e,t){if(e&&e.nodeType==8&&e.data.startsWith(`$s`))for(var n=1;e=e.nextSibling;){if(e.nodeType==8){if(e.data.startsWith(`$s`))n++;else if(e.data.startsWith(`/$s`)&&!--n)return e}t&&t.push(e)}}function ie(e){e&&(e.__c&&(e.__c.__g|=4),e.__k&&e.__k.some(ie))}function ae(t,n,r){for(var i=0;i<r.length;)se(r[i++],r[i++],r[i++]);e.__c&&e.__c(n,t),t.some(function(n){try{t=n.__h,n.__h=[],t.some(function(e){e.call(n)})}catch(t){e.__e(t,n.__v)}})}function oe(t,n,r,i,a,o,s,c,l,u){var d,f,m,v,b,x,S,C,T=r.props||p,E=n.props,D=n.type;if(D==`svg`?a=`http://www.w3.org/2000/svg`:D==`math`?a=`http://www.w3.org/1998/Math/MathML`:a||=`http://www.w3.org/1999/xhtml`,o){for(d=0;d<o.length;d++)if((b=o[d])&&(D?b.localName==D:b.nodeType==3)){t=b,o[d]=null;break}}if(!t){if(C=u.ownerDocument||document,!D)return C.createTextNode(E);t=C.createElementNS(a,D,E.is?E:u),c&&=(e.__m&&e.__m(n,o),!1),o=null}if(D){if(u=D==`template`&&t.content||t,o=D==`textarea`&&E.defaultValue!=null?null:o&&_.call(u.childNodes),!c&&o)for(T={},d=0;d<t.attributes.length;d++)T[(b=t.attributes[d]).name]=b.value;for(d in T)b=T[d],d==`dangerouslySetInnerHTML`?m=b:d==`children`||d in E||d==`value`&&`defaultValue`in E||d==`checked`&&`defaultChecked`in E||te(t,d,null,b,a);for(d in E)b=E[d],d==`children`?v=b:d==`dangerouslySetInnerHTML`?f=b:d==`value`?x=b:d==`checked`?S=b:c&&typeof b!=`function`||T[d]===b||te(t,d,b,T[d],a);f?(c||m&&(f.__html==m.__html||f.__html==t.innerHTML)||(t.innerHTML=f.__html),n.__k=[]):(m&&(t.textContent=``),(D==`foreignObject`||a==`http://www.w3.org/1998/Math/MathML`&&h.test(D))&&(a=`http://www.w3.org/1999/xhtml`),k(u,g(v)?v:[v],n,r,i,a,o,s,o?o[0]:r.__k&&w(r,0),c,l),o&&o.some(y)),c&&D!=`textarea`||(d=`value`,D==`progress`&&x==null?t.removeAttribute(d):x==null||x===t[d]&&(D!=`progress`||x)||te(t,d,x,T[d],a),d=`checked`,S!=null&&S!=t[d]&&te(t,d,S,T[d],a))}else T===E||c&&t.data==E||(t.data=E);return t}function se(t,n,r,i){try{typeof t==`function`?n?n.__x=t(n)||1:(i&&=i.__c||i.__e)&&(n=i.__x)&&(i.__x=null,typeof n==`function`?n():t(null)):t.current=n}catch(t){e.__e(t,r)}}function ce(t,n,r){var i,a,o,s;if(e.unmount&&e.unmount(t),!(i=t.ref)||i.current&&i.current!=t.__e||se(i,null,n,t),i=t.__c){if(i.componentWillUnmount)try{i.componentWillUnmount()}catch(t){e.__e(t,n)}i.__P=i.__n=null}if(i=t.__k)for(s=0;s<i.length;s++)i[s]&&ce(i[s],n,typeof t.type!=`function`||r&&!t.props.__P);!r&&(i=t.__c)&&(i=i.__z)&&(a=re(i,o=[]))&&(i==t.__e&&o.some(y),y(a),y(i)),r||y(t.__e),t.__e=t.__c=t.__=null}function le(e,t,n){return this.constructor(e,n)}function ue(t,n){var r,i,a,o;e.__&&e.__(t,n),n.nodeType==9&&(n=n.documentElement),i=(r=t&&32&t.__u)?null:n.__k,n.__k=x(S,{children:[t]}),a=[],o=[],N(n,n.__k,i||p,p,n.namespaceURI,i?null:n.firstChild?_.call(n.childNodes):null,a,i?i.__e:n.firstChild,r,o),ae(a,n.__k,o),n.__k.props.children=null}function de(e){function t(e){var n,r;return this.getChildContext||(n=new Set,(r={})[t.__c]=this,this.getChildContext=function(){return r},this.shouldComponentUpdate=function(e){this.props.value!=e.value&&n.forEach(function(e){e.__g|=4,D(e)})},this.sub=function(e){n.add(e);var t=e.componentWillUnmount;e.componentWillUnmount=function(){n.delete(e),t&&t.call(e)}}),e.children}return t.__c=`__cC`+d++,t.__=e,t.Provider=(t.Consumer=function(e,t){return e.children(t)}).contextType=t,t}e={__e:function(e,t,n,r){for(var i,o,s;t=t.__;)if((i=t.__c)&&!(1&i.__g)){i.__g|=4;try{if((s=(o=i.constructor)&&o.getDerivedStateFromError)&&i.setState(o.getDerivedStateFromError(e)),i.componentDidCatch&&(i.componentDidCatch(e,r||{}),s=1),s&&8&i.__g)return void(i.__g|=2)}catch(t){e=t}}throw a=0,e}},t=0,n=function(e){return e!=null&&e.constructor===f},C.prototype.setState=function(e,t){var n=this.__s;n&&n!=this.state||(n=this.__s=v({},this.state)),typeof e==`function`&&(e=e(v({},n),this.props)),e&&(v(n,e),this.__v&&(t&&this.__k.push(t),D(this)))},C.prototype.forceUpdate=function(e){this.__v&&(this.__g|=4,e&&this.__h.push(e),D(this))},C.prototype.render=S,r=[],a=0,o=function(e,t){return e.__v.__b-t.__v.__b},s=Symbol(),c=/(PointerCapture)$|Capture$/i,l=0,u={},d=0;var fe,pe,me,he,ge=Object.is,_e=0,ve=[],ye=[],be=e,xe=be.__b,Se=be.__r,Ce=be.diffed,we=be.__c,P=be.unmount,Te=be.__;function Ee(e,t){be.__h&&be.__h(pe,e,_e||t),_e=0;var n=pe.__H||(pe.__H={__:[],__h:[]});return e>=n.__.length&&n.__.push({}),n.__[e]}function De(e){return _e=1,F(Re,e)}function F(e,t,n){var r=Ee(fe++,2);if(r.t=e,!r.__c&&(r.__=[n?n(t):Re(void 0,t),function(e){var t=(r.__N||r.__)[0],n=r.t(t,e);ge(t,n)||(r.__N=[n,r.__[1]],r.__c.setState({}))}],r.__c=pe,!pe.__f)){pe.__f=!0;var i=pe.shouldComponentUpdate;pe.shouldComponentUpdate=function(e,t,n){var r=this.__H;if(!r)return!0;var a=!1,o=this.props!=e;if(r.__.some(function(e){e.__N&&(a=!0,ge(e.__[0],e.__N[0])||(o=!0))}),i){var s=i.call(this,e,t,n);return a?s||o:s}return!a||o}}return r.__}function I(e,t){var n=Ee(fe++,3);!be.__s&&Le(n.__H,t)&&(n.__P=!0,n.__=e,n.u=t,pe.__H.__h.push(n))}function L(e,t){var n=Ee(fe++,4);!be.__s&&Le(n.__H,t)&&(n.__P=!1,n.__=e,n.u=t,pe.__h.push(n))}function R(e){return _e=5,Oe(function(){return{current:e}},[])}function Oe(e,t){var n=Ee(fe++,7);return Le(n.__H,t)&&(n.__=e(),n.__H=t),n.__}function ke(e,t){return _e=8,Oe(function(){return e},t)}function Ae(e){var t=pe.context[e.__c],n=Ee(fe++,9);return n.c=e,t?(n.__??(n.__=!0,t.sub(pe)),t.props.value):e.__}function je(){var e;do{for(;e=ye.shift();)try{Fe(e)}catch(t){be.__e(t,{__:(e=e.__P)&&e.__v})}for(;e=ve.shift();){var t=e.__H;if(e.__P&&t)try{t.__h.some(Fe),t.__h.some(Ie),t.__h=[]}catch(n){t.__h=[],be.__e(n,e.__v)}}}while(ye.length)}be.__b=function(e){pe=null,xe&&xe(e)},be.__=function(e,t){e&&t.__k&&t.__k.__m&&(e.__m=t.__k.__m),Te&&Te(e,t)},be.__r=function(e){Se&&Se(e),fe=0;var t=(pe=e.__c).__H;t&&(me==pe?pe.__h=[]:(t.__h.some(Fe),t.__h.some(Ie),fe=0),t.__h=[],t.__.some(function(e){e.__N&&(e.__=e.__N),e.u=e.__N=void 0})),me=pe},be.diffed=function(e){Ce&&Ce(e);var t=e.__c;t&&t.__H&&(t.__H.__h.length&&Pe(ve.push(t)),t.__H.__.some(function(e){e.u&&(e.__H=e.u)})),me=pe=null},be.__c=function(e,t){t.some(function(e){try{e.__h.some(Fe),e.__h=e.__h.filter(function(e){return!e.__||Ie(e)})}catch(t){e.__h=[function(){throw t}]}}),we&&we(e,t)},be.unmount=function(e){P&&P(e);var t,n,r=e.__c;r&&r.__H&&(r.__H.__.some(function(r){try{if(r.__P&&r.__c){if(n===void 0){for(n=e.__;n&&(!n.__c||!n.__c.__P);)n=n.__;n&&=n.__c}r.__P=n,Pe(ye.push(r))}else Fe(r)}catch(e){t=e}}),r.__H=void 0,t&&be.__e(t,r.__v))};var Me=typeof requestAnimationFrame==`function`;function Ne(e){var t,n=function(){clearTimeout(r),Me&&cancelAnimationFrame(t),setTimeout(e)},r=setTimeout(n,35);Me&&(t=requestAnimationFrame(n))}function Pe(e){e!=1&&he==be.requestAnimationFrame||((he=be.requestAnimationFrame)||Ne)(je)}function Fe(e){var t=pe,n=e.__c;typeof n==`function`&&(e.__c=void 0,n()),pe=t}function Ie(e){var t=pe;e.__c=e.__(),pe=t}function Le(e,t){return!e||e.length!=t.length||t.some(function(t,n){return!ge(t,e[n])})}function Re(e,t){return typeof t==`function`?t(e):t}var ze=Symbol.for(`preact-signals`);function Be(){if(Ke>1)Ke--;else{var e,t=!1;for((function(){var e=Xe;for(Xe=void 0;e!==void 0;){var t=e.S;if(t.v===e.v)for(var n=t.t;n!==void 0;n=n.x)n.i===e.i&&(n.i=t.i);e=e.o}})();Ge!==void 0;){var n=Ge;for(Ge=void 0,qe++;n!==void 0;){var r=n.u;if(n.u=void 0,n.f&=-3,!(8&n.f)&&et(n))try{n.c()}catch(n){t||=(e=n,!0)}n=r}}if(qe=0,Ke--,t)throw e}}function Ve(e){if(Ke>0)return e();Ye=++Je,Ke++;try{return e()}finally{Be()}}var He,Ue=void 0;function We(e){var t=Ue,n=He;Ue=void 0,He=void 0;try{return e()}finally{Ue=t,He=n}}var Ge=void 0,Ke=0,qe=0,Je=0,Ye=0,Xe=void 0,Ze=0;function Qe(e){if(Ue!==void 0){var t=e.n;if(t===void 0||t.t!==Ue)return t={i:0,S:e,p:Ue.s,n:void 0,t:Ue,e:void 0,x:void 0,r:t},Ue.s!==void 0&&(Ue.s.n=t),Ue.s=t,e.n=t,32&Ue.f&&e.S(t),t;if(t.i===-1)return t.i=0,t.n!==void 0&&(t.n.p=t.p,t.p!==void 0&&(t.p.n=t.n),t.p=Ue.s,t.n=void 0,Ue.s.n=t,Ue.s=t),t}}function $e(e,t){this.v=e,this.i=0,this.n=void 0,this.t=void 0,this.l=0,this.W=t?.watched,this.Z=t?.unwatched,this.name=t?.name}$e.prototype.brand=ze,$e.prototype.h=function(){return!0},$e.prototype.S=function(e){var t=this,n=this.t;n!==e&&e.e===void 0&&(e.x=n,this.t=e,n===void 0?We(function(){var e;(e=t.W)==null||e.call(t)}):n.e=e)},$e.prototype.U=function(e){var t=this;if(this.t!==void 0){var n=e.e,r=e.x;n!==void 0&&(n.x=r,e.e=void 0),r!==void 0&&(r.e=n,e.x=void 0),e===this.t&&(this.t=r,r===void 0&&We(function(){var e;(e=t.Z)==null||e.call(t)}))}},$e.prototype.subscribe=function(e){var t=this;return ct(function(){var n=t.value;We(function(){return e(n)})},{name:`sub`})},$e.prototype.valueOf=function(){return this.value},$e.prototype.toString=function(){return this.value+``},$e.prototype.toJSON=function(){return this.value},$e.prototype.peek=function(){var e=this;return We(function(){return e.value})},Object.defineProperty($e.prototype,"value",{get:function(){var e=Qe(this);return e!==void 0&&(e.i=this.i),this.v},set:function(e){if(e!==this.v){if(qe>100)throw Error(`Cycle detected`);(function(e){Ke!==0&&qe===0&&e.l!==Ye&&(e.l=Ye,Xe={S:e,v:e.v,i:e.i,o:Xe})})(this),this.v=e,this.i++,Ze++,Ke++;try{for(var t=this.t;t!==void 0;t=t.x)t.t.N()}finally{Be()}}}});function z(e,t){return new $e(e,t)}function et(e){for(var t=e.s;t!==void 0;t=t.n)if(t.S.i!==t.i||!t.S.h()||t.S.i!==t.i)return!0;return!1}function tt(e){for(var t=e.s;t!==void 0;t=t.n){var n=t.S.n;if(n!==void 0&&(t.r=n),t.S.n=t,t.i=-1,t.n===void 0){e.s=t;break}}}function nt(e){for(var t=e.s,n=void 0;t!==void 0;){var r=t.p;t.i===-1?(t.S.U(t),r!==void 0&&(r.n=t.n),t.n!==void 0&&(t.n.p=r)):n=t,t.S.n=t.r,t.r!==void 0&&(t.r=void 0),t=r}e.s=n}function rt(e,t){$e.call(this,void 0,t),this.x=e,this.s=void 0,this.g=Ze-1,this.f=4}rt.prototype=new $e,rt.prototype.h=function(){if(this.f&=-3,1&this.f)return!1;if((36&this.f)==32||(this.f&=-5,this.g===Ze))return!0;if(this.g=Ze,this.f|=1,this.i>0&&!et(this))return this.f&=-2,!0;var e=Ue;try{tt(this),Ue=this;var t=this.x();(16&this.f||this.v!==t||this.i===0)&&(this.v=t,this.f&=-17,this.i++)}catch(e){this.v=e,this.f|=16,this.i++}return Ue=e,nt(this),this.f&=-2,!0},rt.prototype.S=function(e){if(this.t===void 0){this.f|=36;for(var t=this.s;t!==void 0;t=t.n)t.S.S(t)}$e.prototype.S.call(this,e)},rt.prototype.U=function(e){if(this.t!==void 0&&($e.prototype.U.call(this,e),this.t===void 0)){this.f&=-33;for(var t=this.s;t!==void 0;t=t.n)t.S.U(t)}},rt.prototype.N=function(){if(!(2&this.f)){this.f|=6;for(var e=this.t;e!==void 0;e=e.x)e.t.N()}},Object.defineProperty(rt.prototype,"value",{get:function(){if(1&this.f)throw Error(`Cycle detected`);var e=Qe(this);if(this.h(),e!==void 0&&(e.i=this.i),16&this.f)throw this.v;return this.v}});function B(e,t){return new rt(e,t)}function it(e){var t=e.j;if(e.j=void 0,typeof t==`function`){Ke++;var n=Ue;Ue=void 0;try{t()}catch(t){throw e.f&=-2,e.f|=8,at(e),t}finally{Ue=n,Be()}}}function at(e){for(var t=e.s;t!==void 0;t=t.n)t.S.U(t);e.x=void 0,e.s=void 0,it(e)}function ot(e){if(Ue!==this)throw Error(`Out-of-order effect`);nt(this),Ue=e,this.f&=-2;try{8&this.f&&at(this)}finally{Be()}}function st(e,t){this.x=e,this.j=void 0,this.s=void 0,this.u=void 0,this.f=32,this.name=t?.name,He&&He.push(this)}st.prototype.c=function(){var e=this.S();try{if(8&this.f||this.x===void 0)return;var t=this.x();typeof t==`function`&&(this.j=t)}finally{e()}},st.prototype.S=function(){if(1&this.f)throw Error(`Cycle detected`);this.f|=1,this.f&=-9,it(this),tt(this),Ke++;var e=Ue;return Ue=this,ot.bind(this,e)},st.prototype.N=function(){2&this.f||(this.f|=2,this.u=Ge,Ge=this)},st.prototype.d=function(){this.f|=8,1&this.f||at(this)},st.prototype.dispose=function(){this.d()};function ct(e,t){var n=new st(e,t);try{n.c()}catch(e){throw n.d(),e}var r=n.d.bind(n);return r[Symbol.dispose]=r,r}var lt,ut,dt,ft=typeof window<`u`&&!!window.__PREACT_SIGNALS_DEVTOOLS__,pt=[],mt=[];ct(function(){lt=this.N})();function ht(t,n){e[t]=n.bind(null,e[t]||function(){})}function gt(e){if(dt){var t=dt;dt=void 0,t()}dt=e&&e.S()}function _t(e){var t=this,r=e.data,i=V(r);i.name=`ReactiveDom`,i.value=r;var a=Oe(function(){for(var e=t,r=t.__v;r=r.__;)if(r.__c){r.__c.__$f|=4;break}var a=B(function(){var e=i.value.value;return e===0?0:!0===e?``:e||``}),o=B(function(){return!Array.isArray(a.value)&&!n(a.value)}),s=ct(function(){if(this.N=Tt,o.value){var t=a.value;e.__v&&e.__v.__e&&e.__v.__e.nodeType===3&&(e.__v.__e.data=t)}}),c=t.__$u.d;return t.__$u.d=function(){s(),c.call(this)},[o,a]},[]),o=a[0],s=a[1];return o.value?s.peek():s.value}_t.displayName=`ReactiveTextNode`,Object.defineProperties($e.prototype,{constructor:{configurable:!0,value:b(S,null).constructor},type:{configurable:!0,value:_t},props:{configurable:!0,get:function(){var e=this;return{data:{get value(){return e.value}}}}},__b:{configurable:!0,value:1}}),ht(`__b`,function(e,t){if(gt(),ut=void 0,typeof t.type==`string`){var n,r=t.props;for(var i in r)if(i!==`children`){var a=r[i];a instanceof $e&&(n||(t.__np=n={}),n[i]=a,r[i]=a.peek())}}e(t)}),ht(`__r`,function(e,t){if(e(t),t.type!==S){gt();var n,r=t.__c;r&&(r.__$f&=-2,(n=r.__$u)===void 0&&(r.__$u=n=function(e,t){var n;return ct(function(){n=this},{name:t}),n.c=e,n}(function(e){return function(){var t;ft&&((t=this.y)==null||t.call(this)),e.__$f|=1,e.setState({})}}(r),typeof t.type==`function`?t.type.displayName||t.type.name:``))),ut=r,gt(n)}}),ht(`__e`,function(e,t,n,r){gt(),ut=void 0,e(t,n,r)}),ht(`diffed`,function(e,t){gt(),ut=void 0;var n;if(typeof t.type==`string`&&(n=t.__e)){var r=t.__np,i=t.props,a=n.U;if(a)for(var o in a){var s=a[o];s===void 0||r&&o in r||(s.d(),a[o]=void 0)}if(r)for(var c in a||(a={},n.U=a),r){var l=a[c],u=r[c];l===void 0?(l=vt(n,c,u,i),a[c]=l):l.o(u,i)}}e(t)});function vt(e,t,n,r){var i=t in e&&e.ownerSVGElement===void 0,a=z(n);return{o:function(e,t){a.value=e,r=t},d:ct(function(){this.N=Tt;var n=a.value.value;r[t]!==n&&(r[t]=n,i?e[t]=n:n!=null&&(!1!==n||t[4]===`-`)?e.setAttribute(t,n):e.removeAttribute(t))})}}ht(`unmount`,function(e,t){if(typeof t.type==`string`){var n=t.__e;if(n){var r=n.U;if(r)for(var i in n.U=void 0,r){var a=r[i];a&&a.d()}}var o=t.__np;if(o){var s=t.props;for(var c in o)s[c]=o[c]}t.__np=void 0}else{var l=t.__c;if(l){l.__$f|=8;var u=l.__$u;u&&(l.__$u=void 0,u.d())}}e(t)}),ht(`__h`,function(e,t,n,r){r<3&&(t.__$f|=2),e(t,n,r)}),C.prototype.shouldComponentUpdate=function(e,t){if(this.__R)return!0;var n=this.__$u,r=n&&n.s!==void 0;for(var i in t)return!0;if(this.__f||typeof this.u==`boolean`&&!0===this.u){var a=2&this.__$f;if(!(r||a||4&this.__$f)||1&this.__$f)return!0}else if(!(r||4&this.__$f)||3&this.__$f)return!0;for(var o in e)if(o!==`__source`&&e[o]!==this.props[o])return!0;for(var s in this.props)if(!(s in e))return!0;return!1};function V(e,t){return Oe(function(){return z(e,t)},[])}function yt(e,t){var n=R(e);return n.current=e,ut.__$f|=4,Oe(function(){return B(function(){return n.current()},t)},[])}var bt=typeof requestAnimationFrame>`u`?setTimeout:function(e){var t=function(){clearTimeout(n),cancelAnimationFrame(r),e()},n=setTimeout(t,35),r=requestAnimationFrame(t)},xt=function(e){queueMicrotask(function(){queueMicrotask(e)})};function St(){Ve(function(){for(var e;e=pt.shift();)lt.call(e)})}function Ct(){pt.push(this)===1&&(e.requestAnimationFrame||bt)(St)}function wt(){Ve(function(){for(var e;e=mt.shift();)lt.call(e)})}function Tt(){mt.push(this)===1&&(e.requestAnimationFrame||xt)(wt)}function Et(e,t){var n=R(e);n.current=e;var r=ut;I(function(){return ct(function(){if(this.N=Ct,!(r&&8&r.__$f))return n.current()},t)},[])}function Dt(e,t,n=`${t}s`){return`${e} ${e===1?t:n}`}function Ot(e){if(!e.length)return{mean:null,deviation:null};let t=e.reduce((e,t)=>e+t,0)/e.length,n=e.reduce((e,n)=>e+(n-t)**2,0);return{mean:t,deviation:e.length>1?Math.sqrt(n/(e.length-1)):null}}function kt(e,t){let n=new Map;return e.forEach((e,r)=>{let i=t(e,r),a=n.get(i);a?a.push(e):n.set(i,[e])}),n}function At(e){let t=new WeakMap;return n=>{let r=t.get(n)??e(n);return t.set(n,r),r}}var jt=class{limit;entries=new Map;constructor(e){this.limit=e}get(e){let t=this.entries.get(e);return t!==void 0&&this.set(e,t),t}set(e,t){this.entries.delete(e),this.entries.set(e,t);let[n]=this.entries.keys();this.entries.size>this.limit&&this.entries.delete(n)}delete(e){this.entries.delete(e)}values(){return this.entries.values()}};function Mt(e,t,n={}){let r=Object.entries(t);for(let[t,i]of r)e.addEventListener(t,i,n);return()=>{for(let[t,i]of r)e.removeEventListener(t,i,n)}}function Nt(e){try{return JSON.parse(localStorage.getItem(e)??`null`)}catch{return null}}function Pt(){document.fullscreenElement?document.exitFullscreen():document.querySelector(`.layout`)?.requestFullscreen()}function Ft(e){return new Promise(t=>setTimeout(t,e))}function It({segments:e},t){return e.filter(e=>e.level===t&&e.kind!==`transition`).length}function Lt({segments:e}){return e.filter(({checked:e})=>e).length}function Rt(e){return`${Dt(It(e,`activity`),`activity`,`activities`)}, ${Dt(It(e,`primitive`),`primitive`)}`}function zt(e,t){return(e?.segments.filter(e=>e.level===t)??[]).sort((e,t)=>e.start_frame-t.start_frame)}function Bt({segments:e},{level:t,start_frame:n}){return e.find(e=>e.level===t&&e.start_frame===n)}function Vt(e,t){return e.level.localeCompare(t.level)||e.start_frame-t.start_frame}function Ht(e,t){return e.start_frame-t.start_frame||e.level.localeCompare(t.level)}function Ut({level:e,start_frame:t}){return`${e} ${t}`}function Wt(e,t){return e[qt(e,t)]}var Gt=At(e=>zt(e,`primitive`));function Kt(e,t){return Wt(Gt(e),Math.floor(t*e.fps+1e-6))}function qt(e,t){return e.length?Jt(e,e=>e.start_frame<=t,1)-1:-1}function Jt(e,t,n=0){let r=e.length;for(;n<r;){let i=n+r>>1;t(e[i])?n=i+1:r=i}return n}function Yt(e,t){let n=qt(e,t),r=[e[n],e[n+1]].filter(e=>e!==void 0&&e.start_frame>0),i=e=>Math.abs(e.start_frame-t);return r.sort((e,t)=>i(e)-i(t))[0]??null}function Xt(e,t={}){return[...kt(e,({cluster:e})=>e)].filter(([e])=>e>=0).sort(([e],[t])=>e-t).map(([e,n])=>{let r=Qt(n);return{id:e,label:t[e]??``,members:n,total_s:r,mean_s:r/n.length}})}function Zt(e){return e.stop_s-e.start_s}function Qt(e){return e.reduce((e,t)=>e+Zt(t),0)}function $t(e){return e.label?e.label:e.cluster>=0?`cluster ${e.cluster}`:e.kind===`transition`?`transition`:`no cluster`}function en(e,t){let n=t.length?t.map(t=>t.label?t:{...t,label:e[t.activity]?.label??``}):e,r=[];for(let e of n){let t=r.at(-1);e.label&&(t&&t.label===e.label&&t.stop_frame===e.start_frame?r[r.length-1]={...t,stop_frame:e.stop_frame,stop_s:e.stop_s}:r.push(e))}return r}function tn(e){return[...kt(e,({label:e})=>e)].filter(([e])=>e).map(([e,t])=>({label:e,count:t.length,total_s:Qt(t)})).sort((e,t)=>t.total_s-e.total_s)}function nn(e){let t=kt(zt(e,`primitive`).filter(({kind:e})=>e===`primitive`),({activity:e})=>e);return zt(e,`activity`).flatMap((e,n)=>{let r=t.get(n)??[];if(e.kind===`transition`||!r.length)return[];let i=r.map(Zt),a=r.map(e=>e.excluded??!1);return[{activity:e,durations:i,leftOut:a,...Ot(i.filter((e,t)=>!a[t]))}]})}var rn=.2;function an(e,t,n){return(n-e.start_s)/(e.stop_s-e.start_s)*t}function on(e,t,n){return e.start_s+n/t*(e.stop_s-e.start_s)}function sn(e,t,n,r){let i=e.stop_s-e.start_s,a=Math.min(Math.max(i*t,Math.min(rn,r)),r),o=n-(n-e.start_s)/i*a;return un({start_s:o,stop_s:o+a},r)}function cn(e,t,n){return un({start_s:e.start_s+t,stop_s:e.stop_s+t},n)}function ln(e,t,n){let r=e.stop_s-e.start_s;return e.start_s<=t&&t<=e.stop_s?e:cn(e,t-e.start_s-.08*r,n)}function un(e,t){let n=Math.min(e.stop_s-e.start_s,t),r=Math.min(Math.max(e.start_s,0),t-n);return{start_s:r,stop_s:r+n}}var dn=[.01,.02,.05,.1,.2,.5,1,2,5,10,15,30,60,120,300,600,900,1800,3600];function fn(e,t,n=64){let r=(e.stop_s-e.start_s)/Math.max(t,1)*n,i=dn.find(e=>e>=r)??7200,a=i<.1?2:+(i<1),o=[];for(let t=Math.ceil(e.start_s/i-1e-9);t*i<=e.stop_s+1e-9;t++)o.push({seconds:t*i,label:pn(t*i,a)});return o}function pn(e,t=0){let n=Math.round(e*10**t),r=Math.floor(n/10**t),i=t?`.${String(n%10**t).padStart(t,`0`)}`:``,a=e=>String(e).padStart(2,`0`),[o,s,c]=[Math.floor(r/3600),Math.floor(r/60)%60,r%60];return(o?`${o}:${a(s)}`:`${s}`)+`:${a(c)}${i}`}var mn=[`#332288`,`#DDCC77`,`#117733`,`#CC6677`,`#88CCEE`,`#882255`,`#999933`,`#44AA99`,`#AA4499`],hn=`#DDDDDD`,gn=[{share:0,grey:0},{share:.5,grey:255},{share:.4,grey:0}].flatMap(({share:e,grey:t})=>mn.map(n=>wn(Cn(n).map(n=>Tn((1-e)*n+e*t)))));function _n(e){return e<0?hn:gn[e%gn.length]}function vn(e){let t=new Map;for(let{label:n,cluster:r,start_s:i,stop_s:a}of e){if(!n)continue;let e=t.get(n)??new Map;t.set(n,e),r>=0&&e.set(r,(e.get(r)??0)+a-i)}let n=new Set(e.map(({cluster:e})=>_n(e))),r=new Map;for(let e of[...t.keys()].sort()){let[i]=[...t.get(e)].sort((e,t)=>t[1]-e[1]),a=i?_n(i[0]):yn(e,n);n.add(a),r.set(e,a)}return r}function yn(e,t){let n=2166136261;for(let t=0;t<e.length;t++)n=Math.imul(n^e.charCodeAt(t),16777619);n>>>=0;for(let e=0;e<gn.length;e++){let r=_n(n+e);if(!t.has(r))return r}return _n(n)}function bn(e){let t=Sn(e);return 1.05/(t+.05)>=(t+.05)/.05?`#FFFFFF`:`#000000`}function xn(e,t){let n=Sn(e),r=t===`dark`,i=r?Math.max(0,.45-3*n):Math.max(0,.6*(n-.55));return wn(Cn(e).map(e=>Math.round((1-i)*e+i*(r?255:0))))}function Sn(e){let[t,n,r]=Cn(e).map(e=>{let t=e/255;return t<=.04045?t/12.92:((t+.055)/1.055)**2.4});return .2126*t+.7152*n+.0722*r}function Cn(e){let t=t=>parseInt(e.slice(t,t+2),16);return[t(1),t(3),t(5)]}function wn(e){return`#`+e.map(e=>e.toString(16).padStart(2,`0`).toUpperCase()).join(``)}function Tn(e){let t=Math.floor(e);return e-t===.5?t%2==0?t:t+1:Math.round(e)}var En=1/30,Dn=12,On={start_s:null,stop_s:null},kn=class{opened=z([]);current=z(0);playhead=z(0);playing=z(!1);speed=z(1);loop=z(null);bounds=z(On);selection=z(null);level=z(`primitive`);cluster=z(null);hovered=z(null);inStep=z(!1);ghost=z(null);follow=z(!0);trails=z(!0);videoTime=z(null);figureFirst=z(!1);muted=z(!1);zoom=z(null);others=z([]);curves=z(!1);levels=z(null);edit=z(null);drag=z(null);active=B(()=>this.opened.value[this.current.value]);recording=B(()=>this.active.value?.recording.value);people=B(()=>{let e=this.recording.value?.file,t=this.opened.value.filter(t=>e&&t.recording.value.file===e);return t.length>1?t:[]});table=B(()=>this.recording.value?.segmentation);fps=B(()=>this.recording.value?.fps??1);duration=B(()=>(this.recording.value?.n_frames??0)/this.fps.value);range=B(()=>this.zoom.value??{start_s:0,stop_s:Math.max(this.duration.value,.001)});frame=B(()=>this.getFrameAt(this.playhead.value));activities=B(()=>zt(this.table.value,`activity`));primitives=B(()=>zt(this.table.value,`primitive`));labels=B(()=>en(this.activities.value,this.primitives.value));labelColors=B(()=>vn([...this.table.value?.segments??[],...this.others.value.flatMap(({segmentation:e})=>e.segments),...this.people.value.flatMap(({recording:e})=>e.value.segmentation.segments)]));clusters=B(()=>Xt(this.primitives.value,this.table.value?.cluster_names??{}));shownCluster=B(()=>this.clusters.value.find(e=>e.id===this.cluster.value));present=B(()=>Wt(this.primitives.value,this.frame.value));workLevel=B(()=>this.primitives.value.length?this.level.value:`activity`);target=B(()=>Wt(this.getLane(this.workLevel.value),this.frame.value));border=B(()=>Yt(this.getLane(this.workLevel.value),this.frame.value));selected=B(()=>{let e=this.selection.value;return e&&this.table.value?Bt(this.table.value,e):void 0});findIndex(e){return this.opened.value.findIndex(t=>t.recording.value.id===e)}getColor(e){return e.cluster>=0?_n(e.cluster):this.labelColors.value.get(e.label)??null}getFrameAt(e){let t=Math.max((this.recording.value?.n_frames??1)-1,0);return Math.min(Math.max(Math.floor(e*this.fps.value+1e-6),0),t)}getLane(e){return e===`activity`?this.activities.value:this.primitives.value}seek(e){let t=Math.min(Math.max(e,0),this.duration.value);Ve(()=>{this.playhead.value=t;let e=this.selected.value;e&&!jn(e,this.frame.value)&&(this.selection.value=null),this.zoom.value&&(this.zoom.value=ln(this.zoom.value,t,this.duration.value))})}zoomBy(e,t=this.playhead.value){let n=this.duration.value;if(n<=0)return;let r=sn(this.range.value,e,t,n);this.zoom.value=r.stop_s-r.start_s>=n-1e-9?null:r}panBy(e){this.zoom.value&&(this.zoom.value=cn(this.zoom.value,e,this.duration.value))}reveal(e){let{zoom:t}=this;return!t.value||t.value.start_s<=e&&e<=t.value.stop_s?!1:(t.value=ln(t.value,e,this.duration.value),!0)}step(e){this.playing.value=!1,this.seek((this.frame.value+e)/this.fps.value)}select(e,t={}){Ve(()=>{this.level.value=e.level,this.selection.value={level:e.level,start_frame:e.start_frame},e.cluster>=0&&(this.cluster.value=e.cluster),this.loop.value&&(this.loop.value={start_s:e.start_s,stop_s:e.stop_s}),(t.seek??!0)&&this.seek(e.start_s)})}stepSegment(e){let t=this.getLane(this.workLevel.value),n=t[qt(t,this.frame.value)+e];n&&this.select(n)}toggleLevel(){this.setLevel(this.workLevel.value===`activity`?`primitive`:`activity`)}setLevel(e){this.getLane(e).length&&e!==this.workLevel.value&&Ve(()=>{this.level.value=e,this.selection.value=null})}stepDetail(e){let t=this.levels.value,n=t?.all[An(t.detail,t.all)+e];n!==void 0&&t?.choose(n)}selectCluster(e){let t=this.clusters.value.find(t=>t.id===e)?.members??[],n=t.find(e=>jn(e,this.frame.value)),r=t.find(e=>e.start_frame>=this.frame.value);this.cluster.value=e;let i=n??r??t[0];i&&this.select(i)}toggleMark(e){let t=this.getMarkedSpan(),n=this.playhead.value,r=this.bounds.value[e]===n?null:n,i={...this.bounds.value,[e]:r},{start_s:a,stop_s:o}=i;a!==null&&o!==null&&o<=a&&(i[e===`start_s`?`stop_s`:`start_s`]=null),this.bounds.value=i,this.loop.value&&t&&(this.loop.value=this.getMarkedSpan())}getMarkedSpan(){let{start_s:e,stop_s:t}=this.bounds.value;return e===null&&t===null?null:{start_s:e??0,stop_s:t??this.duration.value}}showSegment(e){this.playing.value=!1,this.select(e);let{start_s:t,stop_s:n}=this.range.value;((e.stop_s-e.start_s)/(n-t)<En||e.stop_s>n)&&this.zoomTo(e,Dn)}zoomToTarget(){let e=this.getMarkedSpan()??this.target.value;e&&this.zoomTo(e,1.2)}zoomTo(e,t){let n=e.stop_s-e.start_s,r=Math.min(Math.max(t*n,.2),this.duration.value),i=(e.start_s+e.stop_s-r)/2,a=un({start_s:i,stop_s:i+r},this.duration.value);this.zoom.value=r<this.duration.value?a:null}toggleLoop(){let e=this.getMarkedSpan(),t=this.target.value;this.loop.value||e||!t?this.loop.value=this.loop.value?null:e:(this.select(t,{seek:!jn(t,this.frame.value)}),this.loop.value={start_s:t.start_s,stop_s:t.stop_s})}toggleGhost(){let e=this.present.value??null,t=this.ghost.value?.start_frame===e?.start_frame;this.ghost.value=this.ghost.value&&t?null:e}add(e){this.opened.value=[...this.opened.value,e],this.show(this.opened.value.length-1)}show(e){let t=this.recording.value?.file,n=!!t&&this.opened.value[e]?.recording.value.file===t;Ve(()=>{this.selection.value=null,this.cluster.value=null,this.others.value=[],this.inStep.value=!1,this.ghost.value=null,this.current.value=e,n||(this.loop.value=null,this.zoom.value=null,this.bounds.value=On,this.playing.value=!1)}),this.seek(this.playhead.value)}close(e){this.opened.value=this.opened.value.filter((t,n)=>n!==e);let t=Math.max(this.opened.value.length-1,0),n=+(this.current.value>e);this.show(Math.min(this.current.value-n,t))}};function An(e,t){return Math.max(t.filter(t=>t<=e*(1+1e-9)).length-1,0)}function jn(e,t){return e.start_frame<=t&&t<e.stop_frame&&Zt(e)>0}var Mn=de(null),Nn=Mn.Provider;function Pn(){let e=Ae(Mn);if(!e)throw Error(`A component stands outside of the StoreProvider.`);return e}function Fn({level:e,start_frame:t}){return{level:e,frame:t}}function In({lane:e,frame:t}){let n=e[qt(e,t)];return!n||n.start_frame===t?null:{kind:`split`,level:n.level,frame:t}}function Ln({lane:e,frame:t}){let n=qt(e,t),[r,i]=[e[n],e[n+1]];if(!r||!i)return null;let{level:a,start_frame:o}=r;return{kind:`merge`,level:a,start_frame:o,stop_frame:i.stop_frame}}function Rn(e){let t=Yt(e.lane,e.frame);return t===null?null:{kind:`delete_border`,level:t.level,frame:t.start_frame}}function zn(e,t){let n=Yt(e.lane,e.frame);if(!n)return null;let r=e.lane[e.lane.indexOf(n)-1],i=n.start_frame,a=Math.min(Math.max(i+t,r.start_frame+1),n.stop_frame-1);return a===i?null:{kind:`move_border`,level:n.level,frame:i,to:a}}function Bn({lane:e,frame:t},n){let r=qt(e,t),i=e[r],a=n===`start`?i:e[r+1];return!i||!a||n===`start`&&r===0||i.start_frame===t?null:{kind:`move_border`,level:i.level,frame:a.start_frame,to:t}}function Vn(e,t,n){return e.kind===`move_border`&&e.level===t&&e.frame===n?e.to:null}function Hn(e,t){let n=new Map(e.segments.map(e=>[Ut(e),e]));for(let[e,r]of t.removed)n.delete(Ut({level:e,start_frame:r}));for(let e of t.rows)n.set(Ut(e),e);let r=Un([...n.values()].sort(Vt));return{...e,cluster_names:t.cluster_names,segments:r}}function Un(e){let t=e.filter(({level:e})=>e===`activity`).map(e=>e.start_frame),n=-1,r=``;return e.map(e=>{for(e.level!==r&&([r,n]=[e.level,-1]);t[n+1]<=e.start_frame;)n+=1;return e.activity===n?e:{...e,activity:n}})}function Wn(e,t,n){let r=!1,i=Gn(e,t,(e,i)=>{let a=Bt(t,{level:e,start_frame:i});if(!a||Bt(n,a))return i;let o=n.segments.find(n=>n.level===e&&n.stop_frame===a.stop_frame&&!Bt(t,n));return r||=!o,o?.start_frame??i});return r?null:i}function Gn(e,t,n){let r=(t,{frames:r})=>({...e,frames:r.map(e=>n(t,e))});switch(e.kind){case`move_border`:case`delete_border`:case`name_segment`:case`set_cluster`:case`set_kind`:case`comment`:return{...e,frame:n(e.level,e.frame)};case`merge`:{let{level:t,start_frame:r,stop_frame:i}=e;return{...e,start_frame:n(t,r),stop_frame:n(t,i)}}case`check`:return r(e.level,e);case`exclude`:return r(`primitive`,e);case`split_cluster`:return r(t.segments.filter(t=>t.cluster===e.cluster).some(e=>e.level===`primitive`)?`primitive`:`activity`,e);case`together`:return{...e,edits:e.edits.map(e=>Gn(e,t,n))};default:return e}}var Kn={activity:[`activity`,`activities`],primitive:[`primitive`,`primitives`]};function qn(e,t){let n=e=>`${(e/t).toFixed(2)} s`;switch(e.kind){case`move_border`:return`${e.level} border from ${n(e.frame)} to ${n(e.to)}`;case`split`:return`${e.level} split at ${n(e.frame)}`;case`merge`:return`${Kn[e.level][1]} merged from ${n(e.start_frame)} to ${n(e.stop_frame)}`;case`delete_border`:return`${e.level} border at ${n(e.frame)} deleted`;case`name_segment`:return e.label?`${e.level} at ${n(e.frame)} named “${e.label}”`:`own name of the ${e.level} at ${n(e.frame)} removed`;case`name_cluster`:return e.label?`cluster ${e.cluster} named “${e.label}”`:`name of cluster ${e.cluster} removed`;case`set_cluster`:return e.cluster<0?`${e.level} at ${n(e.frame)} removed from its cluster`:`${e.level} at ${n(e.frame)} put into cluster ${e.cluster}`;case`set_kind`:return e.to===`transition`?`${e.level} at ${n(e.frame)} made a transition`:`transition at ${n(e.frame)} made ${e.level===`activity`?`an`:`a`} ${e.level}`;case`merge_clusters`:return`cluster ${e.cluster} merged into ${e.into}`;case`split_cluster`:return`${Dt(e.frames.length,`segment`)} of cluster ${e.cluster} made a cluster of their own`;case`order_clusters`:return`clusters put into another order`;case`comment`:return e.text?`comment on the ${e.level} at ${n(e.frame)}`:`comment on the ${e.level} at ${n(e.frame)} removed`;case`check`:return`${Dt(e.frames.length,...Kn[e.level])} ${e.checked?`checked`:`not checked any more`}`;case`exclude`:return`${Dt(e.frames.length,`repetition`)} ${e.excluded?`left out of means`:`in means again`}`;case`together`:return e.edits.length===1?qn(e.edits[0],t):`${e.edits.length} edits at once: ${e.edits[0]?qn(e.edits[0],t):``}, …`;case`segment`:return`segmented with ${e.preset}`;case`take_labels`:return`labels of another program taken as the table`;case`transfer`:return`labels from a knowledge base`;case`restore`:return`version ${e.version} restored`;case`undo`:return`undo`;case`redo`:return`redo`}}function Jn({kind:e}){return[`segment`,`transfer`,`take_labels`,`restore`].includes(e)}function Yn(e){if(!Object.keys(e.timings).length)return`Not segmented.`;let t=Object.values(e.timings).reduce((e,t)=>e+t,0);return`${Rt(e)}, found in ${t.toFixed(2)} s.`}function Xn(e){return e.startsWith(`not taken over`)}var Zn=class{session;naming=z(null);segment=B(()=>this.store.target.value);store;heldBorder=null;place={level:`primitive`,frame:0};turnRecording;pressedKey=null;constructor(e){this.session=e,this.store=e.store}edit(e,t){e.kind===`move_border`?this.moveBorder(e):e.kind===`exclude`?this.setExcluded(e.frames,e.excluded):this.send(e,void 0,t)}moveBorder(e){let t=this.store.drag.peek(),n=()=>{this.store.drag.peek()===t&&(this.store.drag.value=null)};this.send(e,n).then(n)}split(){this.runCommand(In,({frame:e})=>e,`There is a border at the playhead already: move the playhead first.`)}mergeWithNext(){this.runCommand(Ln,({lane:e,frame:t})=>Wt(e,t)?.stop_frame,`This is the last segment: choose one with a neighbour after it.`)}deleteBorder(){this.runCommand(Rn,({lane:e,frame:t})=>Yt(e,t)?.start_frame,`There is no border to delete.`)}moveBorderHere(e){this.runCommand(t=>Bn(t,e),({frame:e})=>e,`There is a border at the playhead already, or none on that side to bring here.`)}nudge(e){if(this.heldBorder)return this.extendNudge(e);let t=this.pressedKey??={isDown:!0};this.runCommand(t=>zn(t,e),({lane:e,frame:t})=>Yt(e,t)?.start_frame,`There is no border to move, or no room for it.`,(n,r,i)=>{this.heldBorder??={where:r,by:0,place:i},this.extendNudge(e),t.isDown||this.release()})}release(){if(this.pressedKey&&(this.pressedKey.isDown=!1),this.pressedKey=null,!this.heldBorder)return;let e=zn(this.heldBorder.where,this.heldBorder.by);this.heldBorder=null,e?this.moveBorder(e):this.store.drag.value=null}extendNudge(e){let{where:t,by:n,place:r}=this.heldBorder,i=zn(t,n+e),a=Yt(t.lane,t.frame).start_frame,o=i?.to??a,s=this.store.frame.peek()===r.frame;this.heldBorder={where:t,by:o-a,place:r},r.frame=o,Ve(()=>{this.store.drag.value={lane:r.level,frame:a,to:o},s&&this.store.seek(o/this.store.fps.value)})}startNaming(e){let t=this.segment.value;t&&e===`cluster`&&t.cluster<0?this.session.notifications.refuse(`This segment is in no cluster: there is no cluster to name.`):t&&(this.naming.value=e)}nameSegment(e,t,n){this.edit({kind:`name_segment`,...Fn(e),label:t},n)}nameTarget(e){this.runAtPlayhead(t=>this.nameSegment(t,e))}setChecked(e,t){let n=[`activity`,`primitive`].flatMap(n=>{let r=e.filter(e=>e.level===n).map(e=>e.start_frame);return r.length?[{kind:`check`,level:n,frames:r,checked:t}]:[]});this.sendTogether(n,``)}setExcluded(e,t){let n=t?`left out of means`:`in means again`;this.send({kind:`exclude`,frames:e,excluded:t},()=>{this.session.notifications.tell(`${Dt(e.length,`repetition`)} ${n}.`)})}toggleExcluded(){let e=this.store.selected.value;e?.kind===`primitive`?this.runInTurn((t,{segmentation:n})=>this.setExcluded([e.start_frame],!Bt(n,e)?.excluded)):this.session.notifications.refuse(`Select the repetition to leave out of means first.`)}sendTogether(e,t){e.length&&this.send(e.length===1?e[0]:{kind:`together`,edits:e},()=>{t&&this.session.notifications.tell(`${Dt(e.length,`segment`)} ${t}.`)})}undo(){this.canStep(`can_undo`)?this.session.edited.value?.undo():this.session.notifications.refuse(`There is nothing to undo.`)}redo(){this.canStep(`can_redo`)?this.send({kind:`redo`}):this.session.notifications.refuse(`There is nothing to redo.`)}runAtPlayhead(e){this.runInTurn(({lane:t,frame:n})=>{let r=Wt(t,n);r&&e(r)})}canStep(e){let t=this.session.edited.value;return t!==void 0&&(t.confirmed.value[e]||t.hasPending())}runCommand(e,t,n,r=e=>void this.send(e)){let{start_s:i,stop_s:a}=this.store.range.peek();this.runInTurn((o,s,c)=>{let l=e(o),u=t(o),d=(u??0)/this.store.fps.value,f=i<=d&&d<=a;!l||u===void 0?this.session.notifications.refuse(n):this.turnRecording===this.session.edited.peek()?!f&&this.store.reveal(d)?this.session.notifications.tell(`This is where it would be: press once more to do it.`):r(l,o,c):this.send(l)})}runInTurn(e){let t=this.session.edited.peek(),[n,r]=[this.store.workLevel.peek(),this.store.frame.peek()];(this.place.level!==n||this.place.frame!==r)&&(this.place={level:n,frame:r});let{place:i}=this;t?.runWhenShown(()=>{let{value:r}=t.confirmed,a=zt(r.segmentation,n);this.turnRecording=t,e({lane:a,frame:i.frame},r,i),this.turnRecording=void 0})}send(e,t,n){let r=this.turnRecording??this.session.edited.peek();return r?.edit(e,()=>{if(t?.(),r!==this.session.edited.peek())return;let n=this.store.selection.peek(),i=n&&Vn(e,n.level,n.start_frame);n&&i!==null&&(this.store.selection.value={...n,start_frame:i})},n)??Promise.resolve()}};function Qn(e,t,n={}){return Object.entries(t).reduce((e,[t,n])=>e.replace(`{${t}}`,()=>encodeURIComponent(n)),e)+or(n)}function $n(e,t,n=0){return or({token:e,...t&&{open:t},...n&&{at:n.toFixed(3)}})}function er(){return ar().get(`token`)??``}function tr(e){let t=ar();t.set(`token`,e),history.replaceState(null,``,`?${t}`)}function nr(){return ar().getAll(`open`)}function rr(){return Number(ar().get(`at`))||0}function ir(e){let t=ar();t.delete(`open`),t.delete(`at`);for(let n of e)t.append(`open`,n.recording.peek().id);history.replaceState(null,``,`?${t}`)}function ar(){return new URLSearchParams(location.search)}function or(e){let t=Object.entries(e).map(([e,t])=>[e,String(t)]);return t.length?`?${new URLSearchParams(t)}`:``}var sr=1e3,cr=e=>e.arrayBuffer(),lr=class{token;constructor(e){this.token=e}loadState=()=>this.get(`/api/state`,{});loadTables=()=>this.get(`/api/tables`,{});shareLabels=e=>this.post(`/api/labels`,{},e);makeKnowledge=e=>this.post(`/api/knowledge`,{},e);loadRecording=e=>this.get(`/api/recordings/{id}`,{id:e});sendEdit=(e,t)=>this.post(`/api/recordings/{id}/edits`,{id:e},t);loadPreview=(e,t)=>this.post(`/api/recordings/{id}/preview`,{id:e},t);readAs=(e,t)=>this.post(`/api/recordings/{id}/reading`,{id:e},t);placeVideo=(e,t)=>this.post(`/api/recordings/{id}/video`,{id:e},t);loadProgress=e=>this.get(`/api/recordings/{id}/progress`,{id:e});cancel=e=>this.request(Qn(`/api/recordings/{id}/cancel`,{id:e}),cr,{});loadVersions=e=>this.get(`/api/recordings/{id}/versions`,{id:e});loadVersion=(e,t)=>this.get(`/api/recordings/{id}/versions/{number}`,{id:e,number:t});compare=(e,t)=>this.post(`/api/recordings/{id}/compare`,{id:e},t);loadAnnotators=()=>this.get(`/api/annotators`,{});loadAgreement=e=>this.post(`/api/agreement`,{},e);loadLanes=(e,t)=>this.post(`/api/recordings/{id}/lanes`,{id:e},t);exportSegments=(e,t,n)=>this.download(Qn(`/api/recordings/{id}/export/{format}`,{id:e,format:t},{level:n}));exportAll=(e,t)=>this.download(Qn(`/api/export/{format}`,{format:e},{level:t}));exportClips=(e,t)=>this.download(Qn(`/api/recordings/{id}/clips`,{id:e}),t);loadLoops=e=>this.get(`/api/recordings/{id}/loops`,{id:e});loadLoop=(e,t)=>this.get(`/api/recordings/{id}/loops/{number}`,{id:e,number:t});loadPosesProgress=()=>this.get(`/api/poses`,{});estimatePoses=e=>this.post(`/api/poses`,{},e);cancelPoses=()=>this.request(Qn(`/api/poses/cancel`,{}),cr,{});loadLibrary=()=>this.get(`/api/library`,{});editLibrary=e=>this.post(`/api/library/edits`,{},e);updateTables=e=>this.post(`/api/library/tables`,{},e);nameHits=e=>this.post(`/api/library/names`,{},e);search=e=>this.post(`/api/library/search`,{},e);loadFigure=({recording:e,start_s:t,stop_s:n})=>this.get(`/api/library/figure`,{},{recording:e,start:t,stop:n});renameEverywhere=(e,t)=>this.post(t?`/api/library/everywhere`:`/api/names`,{},e);upload(e,t){return new Promise((n,r)=>{let i=new XMLHttpRequest;i.open(`POST`,Qn(`/api/recordings`,{},{name:e.name})),i.setRequestHeader(`X-Kineme-Token`,this.token),i.setRequestHeader(`Content-Type`,`application/octet-stream`),i.upload.onprogress=e=>{e.lengthComputable&&t(e.loaded/e.total)},i.onerror=()=>r(new fr),i.onload=()=>{let{status:e,responseText:t}=i;e<300?n(JSON.parse(t)):r(br(e,t))},i.send(e)})}listen(e,t,n=!0){let r=new EventSource(Qn(`/api/events`,{},{token:this.token}));r.onmessage=t=>e(JSON.parse(t.data)),r.onopen=()=>{n||t(!0),n=!0},r.onerror=()=>{r.close(),n&&t(!1),setTimeout(()=>this.listen(e,t,!1),sr)}}get(e,t,n){return this.request(Qn(e,t,n),e=>e.json())}post(e,t,n){return this.request(Qn(e,t),e=>e.json(),n)}download(e,t){return this.request(e,async e=>({name:_r(e.headers.get(`content-disposition`)??``)||`kineme`,data:await e.blob()}),t)}async request(e,t,n){let r={"X-Kineme-Token":this.token};n!==void 0&&(r[`Content-Type`]=`application/json`);let i=await yr(fetch(e,{method:n===void 0?`GET`:`POST`,headers:r,body:n===void 0?null:JSON.stringify(n),cache:`no-store`}));if(i.ok)return yr(t(i));throw br(i.status,await yr(i.text()))}},ur=class{api;id;channels=null;constructor(e,t){this.api=e,this.id=t}loadMotion(e){let t=Qn(`/api/recordings/{id}/motion`,{id:this.id},{poses:e});return this.api.request(t,cr)}loadKeypoints(){return this.api.request(Qn(`/api/recordings/{id}/keypoints`,{id:this.id}),cr)}getVideoAddresses(){let{token:e}=this.api;return[Qn(`/api/recordings/{id}/video`,{id:this.id},{token:e})]}loadTile(e,t,n){let r=Qn(`/api/recordings/{id}/matrix/{level}/{row}/{column}`,{id:this.id,level:e,row:t,column:n});return vr(this.api.request(r,e=>e.blob()))}loadCurves(){return this.api.get(`/api/recordings/{id}/curves`,{id:this.id})}loadCurveTile(e,t,n){let r=Qn(`/api/recordings/{id}/curves/{curve}/{level}/{number}`,{id:this.id,curve:e,level:t,number:n});return vr(this.api.request(r,cr))}loadCycleChannels(){let e=async()=>(await this.api.get(`/api/recordings/{id}/cycles`,{id:this.id})).channels;return this.channels??=e().catch(e=>{throw this.channels=null,e}),this.channels}loadClusterCurves(e,t,n,r){let i={channel:t,...r&&{beside:r}};return vr(this.api.get(`/api/recordings/{id}/cycles/{cluster}`,{id:this.id,cluster:e},i))}},dr=class extends Error{status;body;constructor(e,t,n){super(t),this.status=e,this.body=n}},fr=class extends Error{constructor(){super(`The studio's server does not answer.`)}};function pr(e){let t=e instanceof dr?e.body:null;return t?.reading?t.people??[]:null}function mr(e){return e instanceof dr&&!!e.body?.poses}function hr(e){return e instanceof Error?e.message:String(e)}function gr({others:e,left:t}){return(e?` Another name stays with ${Dt(e,`cluster`)} there.`:``)+(t.length?` Not changed: ${t.join(`; `)}.`:``)}function _r(e){let t=/filename\*=utf-8''([^;]+)/i.exec(e)?.[1];return t?decodeURIComponent(t):/filename="?([^";]+)"?/i.exec(e)?.[1]??``}async function vr(e){try{return await e}catch(e){if(e instanceof dr&&e.status===404)return null;throw e}}async function yr(e){try{return await e}catch{throw new fr}}function br(e,t){let n=null;try{n=JSON.parse(t)}catch{}return new dr(e,n?.error??`The server refused this with status ${e}.`,n)}function xr(e){let t=new BroadcastChannel(`kineme.token`),n=e=>new lr(e).loadState().then(()=>!0).catch(e=>!(e instanceof dr));t.onmessage=async({data:t})=>{t!==e.token&&!await n(e.token)&&await n(t)&&(e.token=t,tr(t))},t.postMessage(e.token)}function Sr({name:e,data:t}){let n=document.createElement(`a`);n.href=URL.createObjectURL(t),n.download=e,n.click(),setTimeout(()=>URL.revokeObjectURL(n.href),1e4)}var Cr=500,wr=class{session;progress=z(null);videos=B(()=>this.session.state.value?.recordings.filter(e=>e.needs_poses)??[]);requestedVideo=B(()=>this.videos.value.find(e=>e.id===this.session.videoWithoutPoses.value));install=B(()=>this.session.state.value?.install??``);isPolling=!1;isNew=!0;constructor(e){this.session=e,ct(()=>{let{value:t}=e.state;if(!t||!this.isNew||!this.videos.value.length)return;let n=t.recordings.length===1?this.requestedVideo.value:void 0;(t.recordings.length!==1||n)&&(this.isNew=!1,n&&!t.install?We(()=>void this.start([n.id])):We(()=>void this.pollProgress()))})}async start(e){let{api:t,notifications:n}=this.session;await n.attempt(`poses`,async()=>{this.progress.value=await t.estimatePoses({recordings:[...e]})}),await this.pollProgress()}async cancel(){let{api:e,notifications:t}=this.session;await t.attempt(`poses`,()=>e.cancelPoses()),t.tell(`Cancelled. The poses so far are kept: estimating goes on from there.`)}async pollProgress(){if(this.isPolling)return;this.isPolling=!0;let{api:e,notifications:t}=this.session;try{for(let n=0;;await Ft(Cr)){let r=await e.loadPosesProgress();if(r.done>n&&await this.refresh(),n=r.done,r.recording){this.progress.value=r;continue}let i=r.failed.length>1?` (and ${r.failed.length-1} more)`:``;this.progress.value&&r.failed.length&&t.reportProblem(`${r.failed[0]}${i}`,`poses`);break}}catch(e){t.reportProblem(hr(e),`poses`)}this.progress.value=null,this.isPolling=!1}async refresh(){let{session:e}=this;await e.refresh();let{value:t}=e.videoWithoutPoses;t&&!this.requestedVideo.value&&await e.open(t)}},Tr={level:`activity`,kind:`activity`,start_frame:0,stop_frame:0,start_s:0,stop_s:0,cluster:-1,activity:0,label:``,confidence:null,action:-1,border_confidence:null},Er=class{table;segment;value;parts;constructor(e,t){this.table=e,this.segment=t,this.parts=kr(e,t),this.value=this.parts.length?this.parts.reduce((e,t)=>e*t.value,1):null}get short(){return this.value===null?``:`${Math.round(100*this.value)} %`}get text(){return this.short&&`confidence ${this.short}`}get why(){let{table:e,segment:t,parts:n,short:r}=this;if(!n.length)return jr(e,t);if(Or(e))return`Its confidence is ${r}, a share and no probability.`;let i=n.reduce((e,t)=>t.value<e.value?t:e);return n.length===1?`The confidence ${i.describe()} is ${r}.`:`The confidence that all of this is right is ${r}; the lowest is ${i.describe()}.`}},Dr=At(({segments:e})=>new Set(e.filter(({level:e})=>e===`activity`).map(e=>e.start_frame)));function Or({segments:e}){return e.some(e=>e.level===`primitive`&&e.confidence!==null)&&e.every(e=>e.border_confidence===null)}function kr(e,t){let{start_frame:n,start_s:r,confidence:i,border_confidence:a}=t,o=[];return n>0&&a!==null&&!Ar(e,t)&&o.push({value:a,describe:()=>`that a segment starts at ${pn(r,2)}`}),i!==null&&o.push({value:i,describe:()=>`that this is ${$t(t)}`}),o}function Ar(e,{level:t,start_frame:n}){return t===`primitive`&&Dr(e).has(n)}function jr(e,t){if(Ar(e,t))return`Its confidence is that of its activity, with which it is looked at.`;let{level:n,cluster:r}=t,i=e.segments.filter(e=>e.level===n&&e.cluster===r);return r>=0&&i.length===1?`No other segment is like it.`:`Nothing tells its confidence.`}function Mr(e){return e.segments.filter(({checked:e})=>!e).map(t=>({segment:t,confidence:new Er(e,t)})).sort((e,t)=>(e.confidence.value??2)-(t.confidence.value??2)||Ht(e.segment,t.segment))}function Nr(e,t){let n=e.segments.filter(e=>e.level===t);return[n.filter(({checked:e})=>e).length,n.length]}var Pr=.5;function Fr(e){let{fps:t,n_frames:n}=e,r=new Set(e.checked);return{schema:``,n_frames:n,fps:t,provenance:{},timings:{},segments:e.level.map((n,i)=>({...Tr,level:n,kind:e.kind[i],start_frame:e.start_frame[i],stop_frame:e.stop_frame[i],start_s:e.start_frame[i]/t,stop_s:e.stop_frame[i]/t,cluster:e.cluster[i],activity:e.activity[i],label:e.label[i],confidence:e.confidence[i],border_confidence:e.border_confidence[i],checked:r.has(i)})),cluster_names:{}}}var Ir=At(Mr);function Lr(e){let t=Ir(e).filter(({confidence:{value:e}})=>e!==null&&e<Pr).length;return{all:e.segments.length,checked:Lt(e),doubtful:t}}function Rr(e){return Ir(e)[0]?.confidence.value??null}var zr=At(e=>{let t=zt(e,`activity`),n=t.some(({cluster:e,label:t})=>e>=0||t)?t:zt(e,`primitive`),r=vn(n),i=n.map(({cluster:t,label:n,start_frame:i,stop_frame:a})=>{let o=t>=0?_n(t):r.get(n)??`#DDDDDD`,s=t=>`${(100*t/e.n_frames).toFixed(2)}%`;return`${o} ${s(i)} ${s(a)}`});return i.length?`linear-gradient(to right, ${i.join(`, `)})`:`none`}),Br=500,Vr=class{session;isReady=z(!1);segmenting=z(null);members=B(()=>(this.session.state.value?.recordings??[]).map(e=>{let t=this.serverTables.value.get(e.id),n=this.pageTables.value.get(e.id),r=n?.segments.filter(e=>e.comment).length??t?.comments??0;return{listing:e,table:n??t?.table??null,comments:r}}));tally=B(()=>{let e={all:0,checked:0,doubtful:0};for(let{table:t}of this.members.value){if(!t)continue;let{all:n,checked:r,doubtful:i}=Lr(t);e.all+=n,e.checked+=r,e.doubtful+=i}return e});unsegmented=B(()=>this.members.value.filter(({table:e,listing:t})=>!e&&!t.needs_poses));serverTables=z(new Map);pageTables=z(new Map);pendingRequest=null;isUnanswered=!1;constructor(e){this.session=e,ct(()=>{let t=e.recordings.value.filter(e=>!e.confirmed.value.finding).map(e=>[e.id,e.confirmed.value.segmentation]),n=We(()=>this.pageTables.value);t.some(([e,t])=>n.get(e)!==t)&&(this.pageTables.value=new Map([...n,...t]))}),ct(()=>{let{value:t}=e.state,n=We(()=>this.isReady.value?this.isOutdated():this.isUnanswered);t&&n&&We(()=>void this.refresh())})}refresh(){return this.pendingRequest??=this.loadTables().finally(()=>this.pendingRequest=null),this.pendingRequest}async segmentAll(){if(this.segmenting.value)return;let{api:e,notifications:t}=this.session,n=this.unsegmented.value.map(({listing:e})=>e),r=[];for(let[t,{id:i,name:a}]of n.entries()){this.segmenting.value={done:t,all:n.length};try{for(;(await e.loadRecording(i)).finding;)await Ft(Br)}catch(e){r.push(`${a}: ${hr(e)}`)}t%5==4&&await this.refresh()}await this.refresh(),this.segmenting.value=null,t.clearProblem(`find`);let i=r.length>1?` (and ${r.length-1} more)`:``;r.length&&t.reportProblem(`Not segmented: ${r[0]}${i}`,`find`)}isOutdated(){return this.members.value.some(({listing:e,table:t})=>{if(!t||!e.corrected)return e.corrected;let n=t.segments.filter(({label:e})=>e).length;return[t.segments.length,Lt(t),n].join()!==[e.segments,e.checked,e.named].join()})}async loadTables(){let{session:e}=this;try{let{recordings:t}=await e.api.loadTables(),n=t.flatMap(({id:e,table:t})=>t?[[e,{table:Fr(t),comments:t.comments}]]:[]),r=new Set(e.recordings.value.map(({id:e})=>e));Ve(()=>{this.pageTables.value=new Map([...this.pageTables.value].filter(([e])=>r.has(e))),this.serverTables.value=new Map(n),this.isReady.value=!0}),this.isUnanswered=!1,e.notifications.clearProblem(`tables`)}catch(t){this.isUnanswered=t instanceof fr||t.status===403,this.isUnanswered||e.notifications.reportProblem(hr(t),`tables`)}}},Hr=class{folder;present=z(null);lastNames=null;constructor(e){this.folder=e;let{session:t}=e;ct(()=>{let{id:e,segmentation:n,finding:r}=t.edited.value?.confirmed.value??{};if(!e||!n||r)return;let i=n.cluster_names,a=this.lastNames?.id===e?this.lastNames.names:i;this.lastNames={id:e,names:i};let o=Ur(a,i);We(()=>{this.present.value?.recording!==e&&(this.present.value=null),o&&(this.present.value=this.isUseful(e,o)?{recording:e,...o}:null)})})}async accept(){let{session:e}=this.folder,{api:t,notifications:n}=e,r=this.present.value;r&&(this.present.value=null,await n.attempt(`offer`,async()=>{let i=await t.renameEverywhere(r,this.isLibrary()),a=Dt(i.tables,`saved table`);n.tell(`“${r.label}” in ${a} more.${gr(i)}`),e.state.value&&await e.refresh()}))}isLibrary(){return this.folder.session.state.value?.of_library??!1}isUseful(e,{before:t,label:n}){let r=this.folder.members.value.filter(({listing:t})=>t.id!==e);if(!r.length||!n)return!1;if(this.isLibrary()||t&&!this.folder.isReady.value)return!0;let i=e=>e.segments.some(e=>e.label===t);return t!==``&&r.some(({table:e})=>e&&i(e))}};function Ur(e,t){let n=[...new Set([...Object.keys(e),...Object.keys(t)])].filter(n=>(e[n]??``)!==(t[n]??``)),[r]=n;return r===void 0||n.length>1?null:{cluster:Number(r),before:e[r]??``,label:t[r]??``}}var Wr=class{session;running=z([]);constructor(e){this.session=e}async add(e){let{session:t}=this,n=[],r=e.map(e=>({file:e,name:e.name,share:z(0)}));this.running.value=[...this.running.value,...r];for(let e of r){let{file:r,name:i,share:a}=e,o=`upload ${i}`;try{n.push((await t.api.upload(r,e=>a.value=e)).id),t.notifications.clearProblem(o)}catch(e){t.notifications.reportProblem(`${i}: ${hr(e)}`,o)}this.running.value=this.running.value.filter(t=>t!==e)}await t.refresh();let i=new Set(t.state.value?.recordings.map(e=>e.id)),a=n.find(e=>i.has(e));a&&await t.open(a)}},Gr=class{session;editor;everywhere=z(!1);folder;queue;offer;doubts=B(()=>{let e=this.session.store.table.value;return e?Mr(e):[]});present=B(()=>{let e=this.editor.segment.value,t=e&&Ut(e);return this.doubts.value.find(({segment:e})=>Ut(e)===t)??null});passed=new Set;constructor(e,t){this.session=e,this.editor=t,this.folder=new Vr(e),this.queue=new Jr(this.folder),this.offer=new Hr(this.folder)}async setEverywhere(e){this.everywhere.value=e,e?await this.queue.goToNext():this.queue.current.value=null}async goToNext(){let{everywhere:e,session:t}=this;if(e.value)return this.queue.goToNext();let n=(t.state.value?.recordings.length??0)>1;if(!t.store.recording.value&&n)return this.setEverywhere(!0);let{doubts:r,present:i}=this;i.value&&this.passed.add(Ut(i.value.segment));let a=r.value.find(({segment:e})=>!this.passed.has(Ut(e)));a||=(await t.edited.value?.waitUntilSent(),this.passed.clear(),r.value.find(e=>e!==i.value)??r.value[0]),a?t.store.showSegment(a.segment):t.notifications.tell(`Every segment of this recording is checked.`)}checkAndGoOn(){this.editor.segment.value&&this.session.edited.value?.acceptsEdits()&&(this.editor.runAtPlayhead(e=>this.editor.setChecked([e],!0)),this.goToNext())}toggleChecked(){this.editor.runAtPlayhead(e=>this.editor.setChecked([e],!this.isChecked(e)))}isChecked(e){let t=this.session.store.table.value;return!!(t&&Bt(t,e)?.checked)}},Kr=2,qr=12,Jr=class{folder;places=B(()=>this.folder.members.value.flatMap(({listing:e,table:t})=>t?Xr(e.id,e.name,t):[]).sort((e,t)=>(e.doubt.confidence.value??2)-(t.doubt.confidence.value??2)));current=z(null);passed=new Set;prepared=new Set;constructor(e){this.folder=e}async goToNext(){let{folder:e}=this;e.isReady.value||await e.refresh(),!this.places.value.length&&e.unsegmented.value.length&&await e.segmentAll(),this.passPresent(),this.listUpcoming().length||(await e.session.edited.value?.waitUntilSent(),this.passed.clear());let[t,...n]=this.listUpcoming();t?(await this.goTo(t),this.prepare(n.slice(0,qr))):(this.current.value=null,e.session.notifications.tell(`Every segment of every recording is checked.`))}async goTo(e){let{session:t}=this.folder;this.current.value=e,t.store.recording.value?.id===e.id?this.show(e):await t.open(e.id,{shown:()=>this.show(e)})}show(e){let{store:t}=this.folder.session,n=t.recording.value;n?.id===e.id&&this.current.value===e&&t.showSegment(Qr(n.segmentation,e.doubt.segment))}passPresent(){let{current:e}=this,{recording:t,target:n}=this.folder.session.store;if(!e.value)return;let{id:r,doubt:i}=e.value;this.passed.add(Zr(r,i.segment)),n.value&&t.value?.id===r&&this.passed.add(Zr(r,n.value))}listUpcoming(){return this.places.value.filter(({id:e,doubt:t})=>!this.passed.has(Zr(e,t.segment)))}prepare(e){let{session:t}=this.folder,n=t.recordings.value.map(({id:e})=>e),r=[...new Set(e.map(({id:e})=>e))].filter(e=>!n.includes(e));for(let e of r.slice(0,Kr))this.prepared.has(e)||(this.prepared.add(e),this.prepared.size>6&&this.prepared.delete([...this.prepared][0]),t.api.loadRecording(e).catch(()=>void 0))}},Yr=new WeakMap;function Xr(e,t,n){let r=Yr.get(n)??Ir(n).map(n=>({id:e,recording:t,doubt:n}));return Yr.set(n,r),r}function Zr(e,t){return`${e} ${Ut(t)}`}function Qr(e,{level:t,start_frame:n}){return Wt(zt(e,t),n)??e.segments[0]}var $r=class{dialog=z(null);tab=z(`segment`);folder=z(null);show(e){this.dialog.value=e}};function ei(e){let t=new Zn(e);e.store.edit.value=e=>t.edit(e);let[n,r]=[new Wr(e),new wr(e)];return{session:e,editor:t,uploads:n,poses:r,review:new Gr(e,t),view:new $r}}var ti=de(null),ni=ti.Provider;function H(){let e=Ae(ti);if(!e)throw Error(`A component stands outside of the StudioProvider.`);return e}var ri=[[`S`,`Split at the playhead`],[`M`,`Merge the segment with the next one`],[`Delete`,`Delete the border nearest to the playhead`],[`[, ]`,`The segment starts, or stops, at the playhead`],[`Alt + ← →`,`Move the border nearest to the playhead by a frame; with Shift by ten`],[`A`,`Work on activities, or on primitives again`],[`N`,`Name the segment; Enter takes the name, Escape leaves it`],[`Shift + N`,`Name its cluster`],[`1 … 9`,`Name the segment with a label of the folder (see Segment)`],[`J`,`Next to look at: where confidence is lowest`],[`K`,`The segment is checked: mark it, and go to the next to look at`],[`Shift + K`,`Mark the segment as checked, or take the mark away`],[`X`,`Leave the selected repetition out of mean curves; once more brings it back`],[`Page Down, Page Up`,`The next recording of the list, or the one before`],[`Ctrl + Z`,`Undo`],[`Ctrl + Shift + Z`,`Redo`],[`H`,`Tables that were replaced`],[`T`,`Labels from a knowledge base`],[`C`,`Compare with another result`],[`E`,`Export`],[`Escape`,`Cancel the segmentation that is running, else dismiss what went wrong`],[`?`,`This help`]];function ii(e,{session:t,editor:n,review:r,view:i}){let a=e.key.length===1?e.key.toLowerCase():e.key;if(e.ctrlKey||e.metaKey)return a===`z`?()=>e.shiftKey?n.redo():n.undo():a===`y`?()=>n.redo():void 0;if(e.altKey){let t={ArrowLeft:-1,ArrowRight:1}[a];return t?()=>n.nudge(t*(e.shiftKey?10:1)):void 0}let o=/^[1-9]$/.test(a)?Number(a):0;if(o)return()=>ai(o,t,n);let s={s:()=>n.split(),m:()=>n.mergeWithNext(),Delete:()=>n.deleteBorder(),Backspace:()=>n.deleteBorder(),a:()=>t.store.toggleLevel(),n:()=>n.startNaming(e.shiftKey?`cluster`:`segment`),"[":()=>n.moveBorderHere(`start`),"]":()=>n.moveBorderHere(`stop`),j:()=>void r.goToNext(),k:()=>e.shiftKey?r.toggleChecked():r.checkAndGoOn(),x:()=>n.toggleExcluded(),PageDown:()=>void t.openNext(1),PageUp:()=>void t.openNext(-1),h:()=>i.show(`versions`),t:()=>i.show(`transfer`),c:()=>i.show(`compare`),e:()=>i.show(`export`),"?":()=>i.show(`help`)};return t.segmenting.value?s.Escape=()=>t.cancel():t.notifications.problems.value.length&&(s.Escape=()=>t.notifications.dismiss()),s[a]}function ai(e,t,n){let r=t.state.value?.labels[e-1];r?n.nameTarget(r):t.notifications.tell(`No label is on the key ${e} yet: add it in “Segment”, below.`)}var oi=-32768;async function si(e,t){return li(e,await ci(t).arrayBuffer())}function ci(e){let t=new Blob([e]).stream().pipeThrough(new DecompressionStream(`deflate`));return new Response(t)}function li(e,t){let{n_samples:n}=e,r=e.joints.length*3;if(t.byteLength!==2*n*r)throw Error(`The motion has ${t.byteLength} bytes, not ${2*n*r}.`);let i=new DataView(t),a=new Int16Array(n*r);for(let e=0;e<r;e++){let t=0;for(let o=0;o<n;o++)t+=i.getInt16(2*(e*n+o),!0),a[o*r+e]=t}return{head:e,steps:a}}function ui(e,t,n){let{origin:r,step:i,n_samples:a,sample_fps:o}=e.head,s=Math.min(Math.max(t*o,0),a-1),c=Math.floor(s),l=s-c,u=e.head.joints.length*3,d=c*u,f=Math.min(c+1,a-1)*u;for(let t=0;t<u;t++){let a=e.steps[d+t],o=e.steps[f+t];n[t]=a===oi||o===oi?NaN:r[t%3]+i*(a+l*(o-a))}}function di({head:e}){return new Float32Array(3*e.joints.length)}function fi(e,t){let n=di(e);ui(e,t,n);let r=3*mi(e.head);return[n[r]||0,n[r+2]||0]}function pi(e,t){let{heading:n,sample_fps:r}=e.head;return!n||n.length===0?0:n[Math.min(Math.max(Math.round(t*r),0),n.length-1)]}function mi(e){return Math.max(e.parents.indexOf(-1),0)}function hi(e){let t=atob(e),n=new Uint8Array(t.length);for(let e=0;e<t.length;e++)n[e]=t.charCodeAt(e);return n}function gi(e){return/^\d+$/.test(e)?`person ${e}`:e}async function _i(e){let t=vi(e);for(;;){let{motion:n}=e.recording.peek();if(!n||yi(n,e.motion.peek()))return t;e.motion.value=await si(n,await e.data.loadMotion(n.n_samples))}}async function vi(e){let t=e.recording.peek().video?.picture;t&&!e.keypoints.peek()&&(e.keypoints.value=await si(t.keypoints,await e.data.loadKeypoints()))}function yi({n_samples:e,step:t},n){return n?.head.n_samples===e&&n.head.step===t}var bi=class{page;proposal=B(()=>this.proposed.value?.shown===this.page.store.others.value[0]?this.proposed.value:null);comparison=B(()=>this.proposal.value?null:this.compared.value.get(this.page.store.others.value[0])??null);draft=z(null);proposed=z(null);compared=z(new WeakMap);requestCount=0;constructor(e){this.page=e}async propose(e,t){let n=this.page.edited.value;if(!n)return;let r=++this.requestCount;this.draft.value=e;let{revision:i}=n.confirmed.peek();try{let{preset:a,values:o,detail:s}=e,c={preset:a,parameters:o,detail:s,keep:t},l=await this.page.api.loadPreview(n.id,c);if(r!==this.requestCount||this.page.edited.peek()!==n)return;let u={name:`Preview`,segmentation:l.segmentation,marked:!0};this.proposed.value={choice:e,keep:t,preview:l,shown:u,revision:i},this.page.store.others.value=[u],this.page.notifications.clearProblem(`preview`)}catch(e){r===this.requestCount&&this.page.notifications.reportProblem(hr(e),`preview`)}finally{r===this.requestCount&&(this.draft.value=null)}}cancel(){this.requestCount+=1,this.draft.value=null}apply(){let{value:e}=this.proposal;if(!e||!this.page.edited.value?.acceptsEdits())return;let{choice:t,keep:n}=e;this.discard(),this.page.edited.value?.edit({kind:`segment`,preset:t.preset,parameters:t.values,detail:t.detail,keep:n})}discard(){this.cancel(),this.proposal.value&&(this.page.store.others.value=[]),this.proposed.value=null}async compare(e){let t=this.page.edited.value;return t?this.page.notifications.attempt(`compare`,async()=>this.showBelow(await this.page.api.compare(t.id,e))):!1}showBelow(e,t=!1){let n={name:e.name,segmentation:e.segmentation,marked:t};this.compared.value.set(n,e),this.page.store.others.value=[n]}stop(){this.page.store.others.value=[]}},xi=class{page;agreement=z(null);recordingAgreement=B(()=>{let e=this.page.store.recording.value?.id;return this.agreement.value?.recordings.find(t=>t.id===e)});chosen=[];lanes=null;constructor(e){this.page=e;let{store:t}=e;ct(()=>{let e=t.recording.value?.id;this.agreement.value&&e&&!t.others.value.length&&We(()=>void this.showLanes(e))})}compare(e){let{api:t,store:n,notifications:r}=this.page;return r.attempt(`agreement`,async()=>{let r=await t.loadAgreement({annotators:e});this.chosen=e,this.lanes=null,n.others.value=[],this.agreement.value=r,this.recordingAgreement.value||await this.page.open(r.recordings[0].id)})}stop(){this.agreement.value=null,this.lanes=null,this.page.store.others.value=[]}async showLanes(e){let{api:t,store:n,notifications:r}=this.page;if(this.lanes?.recording!==e){this.lanes={recording:e,shown:[]};let{chosen:n,agreement:i,lanes:a}=this,o=i.value;try{let r=await t.loadLanes(e,{annotators:n});if(i.peek()!==o||this.lanes!==a)return;this.lanes.shown=r}catch(e){r.reportProblem(hr(e),`agreement`)}}n.recording.peek()?.id===e&&!n.others.peek().length&&this.lanes?.shown.length&&(n.others.value=this.lanes.shown)}},Si=`what it was made on is not there any more`,Ci=`Not done: the studio’s server does not answer.`,wi=`Not done: first choose what becomes of the edits above.`,Ti=class e{context;confirmed;blocked=z(null);busy=B(()=>this.edits.value.some(({edit:e})=>Jn(e)));queue=z([]);edits=B(()=>this.queue.value.filter(Ei));sending=null;isRunningCommand=!1;announcedRevision=0;cancelledName=``;stopStoring;constructor(e,t){this.context=t,this.confirmed=z(e),this.stopStoring=ct(()=>Mi(t.folder,e.id,this.edits.value))}static async open(t,n){let r=await n.api.loadRecording(t),i=await Ni(n.folder,t),a=new e(r,n);return a.queue.value=i,i.length&&a.send(),a}get id(){return this.confirmed.peek().id}acceptsEdits(){if(this.isRunningCommand)return!0;let e=this.context.isOffline()?Ci:this.blocked.peek()===null?``:wi;return e&&this.context.tell(e,!0),e&&this.refreshTable(),!e}edit(e,t,n){if(!this.acceptsEdits())return Promise.resolve();let{segmentation:r,fps:i}=this.confirmed.peek(),a=n?Wn(e,n,r):e;if(!a)return this.context.warn(`Not made: ${qn(e,i)} (${Si}).`),Promise.resolve();let o=this.queue.peek(),s=o.length?null:this.confirmed.peek().revision;return this.queue.value=[...o,{name:crypto.randomUUID(),edit:a,base:s,made:t}],this.send()}runWhenShown(e){this.sending?this.acceptsEdits()&&(this.queue.value=[...this.queue.peek(),e]):e()}waitUntilSent(){return this.sending??Promise.resolve()}cancel(){let e=this.edits.peek()[0];e&&Jn(e.edit)&&(this.cancelledName=e.name),this.context.api.cancel(this.id).catch(()=>void 0)}undo(){this.edit({kind:`undo`})}async resume(){this.sending||(this.announcedRevision=0,this.hasPending()?await this.send():await this.reload())}async handleChange(e){if(this.announcedRevision=e,this.sending||this.hasPending()||e===this.confirmed.peek().revision)return;let t=this.confirmed.peek().finding;if(!await this.reload())return;let{segmentation:n,finding:r,saved:i}=this.confirmed.peek();r||t&&i||this.context.tell(t?Yn(n):`Another tab changed this table. The changed table is shown.`)}retry(){this.rebase(),this.blocked.value=null,this.send()}discardEdits(){Ve(()=>{this.queue.value=[],this.blocked.value=null}),this.resume()}hasPending(){return this.queue.peek().length>0}close(){this.stopStoring()}describeUnsent(){let{fps:e}=this.confirmed.value;return this.queue.value.map(t=>Ei(t)?qn(t.edit,e):`a key pressed since`)}send(){return this.sending??=this.sendAll()}async sendAll(){for(await Promise.resolve();this.hasPending()&&this.blocked.peek()===null&&await this.sendFirst(););this.sending=null,this.announcedRevision>this.confirmed.peek().revision&&await this.handleChange(this.announcedRevision)}async sendFirst(){let[e,...t]=this.queue.peek();if(!Ei(e))return Ve(()=>{this.queue.value=[],this.isRunningCommand=!0;try{e?.()}finally{this.isRunningCommand=!1,this.queue.value=[...this.queue.peek(),...t]}}),!0;if(e.isGone)return this.refuse(e,Si);let{name:n,edit:r,base:i,made:a}=e,o=this.confirmed.peek();try{let e=i??o.revision,t=await this.context.api.sendEdit(this.id,{revision:e,edit:r,name:n}),s=await this.applyAnswer(t);return Ve(()=>{this.queue.value=this.queue.peek().slice(1),this.show(s),a?.()}),this.report(r,s.segmentation,t.notes),!0}catch(t){if(!(t instanceof dr)||t.status===403)this.context.onConnectionLost();else if(t.status===400)return this.refuse(e,t.message);else if(t.status===409)return this.reconsider(o,t.message);else this.blocked.value=t.message;return!1}}async applyAnswer({change:e,segmentation:t,...n}){let r=this.confirmed.peek(),i=e?.of===r.revision?Hn(r.segmentation,e):t;if(!i)return this.context.api.loadRecording(this.id);let{revision:a,can_undo:o,can_redo:s,saved:c}=n,l={revision:a,can_undo:o,can_redo:s,saved:c,finding:!1};return{...r,...l,segmentation:i}}show(e){let{segmentation:t}=this.confirmed.peek();Ve(()=>{this.confirmed.value=e,this.queue.value=this.queue.peek().map(n=>{if(!Ei(n)||n.isGone)return n;let r=Wn(n.edit,t,e.segmentation);return r?{...n,edit:r}:{...n,isGone:!0}})})}refuse({name:e,edit:t},n){let r=this.queue.peek().slice(1),i=t.kind===`undo`||t.kind===`redo`,a=i?-1:Di(r);return this.queue.value=r.filter((e,t)=>t!==a),i||a>=0||e===this.cancelledName?this.context.tell(n,!0):this.context.warn(`Not made: ${qn(t,this.confirmed.peek().fps)} (${n}).`),this.refreshTable(),!0}refreshTable(){let e=this.confirmed.peek();this.confirmed.value={...e,segmentation:{...e.segmentation}}}rebase(){let[e,...t]=this.queue.peek(),n=this.confirmed.peek().revision;e&&Ei(e)&&(this.queue.value=[{...e,base:n},...t])}async reconsider(e,t){if(!await this.reload())return!1;let n=this.confirmed.peek(),[r,i]=[e,n].map(e=>JSON.stringify(e.segmentation.segments)),a=n.revision!==e.revision&&r===i;return a?this.rebase():this.blocked.value=t,a}async reload(){try{let e=this.confirmed.peek(),t=await this.context.api.loadRecording(this.id),n=this.confirmed.peek();return(n===e||t.revision>=n.revision)&&this.show(t),!0}catch(e){return e instanceof fr?this.context.onConnectionLost():this.context.tell(e.message,!0),!1}}report(e,t,n){let r=e.kind===`segment`?[Yn(t)]:[],i=[...r,...n.filter(e=>!r.length||Xn(e))].join(` `);i&&this.context.tell(i)}};function Ei(e){return typeof e!=`function`}function Di(e){let t=0;for(let[n,r]of e.entries()){let e=Ei(r)&&r.edit.kind===`undo`;if(e&&t===0)return n;t+=e?-1:1}return-1}var Oi=`kineme.unsent`,ki=sessionStorage.getItem(`kineme.tab`)??crypto.randomUUID();async function Ai(){await ji(ki)||(ki=crypto.randomUUID(),await ji(ki)),sessionStorage.setItem(`kineme.tab`,ki)}function ji(e){return new Promise(t=>{navigator.locks.request(`${Oi}.${e}`,{ifAvailable:!0},e=>(t(e!==null),e&&new Promise(()=>void 0)))})}function Mi(e,t,n){let r=`${Oi}|${e}|${t}|${ki}`;n.length?localStorage.setItem(r,JSON.stringify(n)):localStorage.removeItem(r)}async function Ni(e,t){let{held:n=[]}=await navigator.locks.query(),r=new Set(n.map(e=>e.name?.slice(14)));r.delete(ki);let i=Object.keys(localStorage).filter(n=>n.startsWith(`${Oi}|${e}|${t}|`)).filter(e=>!r.has(e.split(`|`).at(-1))),a=i.flatMap(e=>JSON.parse(localStorage.getItem(e)));return i.forEach(e=>localStorage.removeItem(e)),a}var Pi=6e3,Fi=class{getTableKey;news=z(null);problems=z([]);timer=0;constructor(e){this.getTableKey=e,ct(()=>{let{value:t}=this.news;t&&t.of!==e()&&(this.news.value=null)})}tell(e,t=!1){this.news.value={text:e,of:We(this.getTableKey),refused:t},window.clearTimeout(this.timer),this.timer=window.setTimeout(()=>this.news.value=null,Pi)}refuse(e){this.tell(e,!0)}reportProblem(e,t){let n=this.problems.value.filter(t=>t.text!==e);this.problems.value=[...n,{text:e,about:t}]}clearProblem(e){this.problems.value.some(t=>t.about===e)&&(this.problems.value=this.problems.value.filter(t=>t.about!==e))}async attempt(e,t){try{return await t(),this.clearProblem(e),!0}catch(t){return this.reportProblem(hr(t),e),!1}}dismiss(e=this.problems.value.at(-1)?.text){this.problems.value=this.problems.value.filter(t=>t.text!==e)}},Ii=[`new`,`corrected`,`labelled`,`checked`],Li=[[``,`all`],...Ii.map(e=>[e,e])],Ri=[[`name`,`by name`],[`left`,`what is left first`],[`size`,`largest first`]],zi=class{state;recordings;search=z(``);order=z(`name`);status=z(``);listed=B(()=>{let e=(this.state.value?.recordings??[]).filter(e=>this.matches(e));return this.order.value===`size`&&e.sort((e,t)=>t.bytes-e.bytes),this.order.value===`left`&&e.sort((e,t)=>Ii.indexOf(this.getStatus(e))-Ii.indexOf(this.getStatus(t))),e});constructor(e,t){this.state=e,this.recordings=t}getStatus(e){let{saved:t,segmentation:n}=this.recordings.value.find(t=>t.id===e.id)?.confirmed.value??{};if(!n||!t)return e.corrected?Bi(e):`new`;let{segments:r}=n;return Bi({segments:r.length,checked:Lt(n),named:r.filter(({label:e})=>e).length,to_name:r.filter(({kind:e})=>e!==`transition`).length})}matches(e){let{value:t}=this.status;return e.name.toLowerCase().includes(this.search.value.trim().toLowerCase())&&(!t||this.getStatus(e)===t)}};function Bi(e){return e.checked>0&&e.checked>=e.segments?`checked`:e.named>0&&e.named>=e.to_name?`labelled`:`corrected`}var Vi=`The studio’s server does not answer. What is shown is saved; nothing can be edited until it is back.`,Hi=`The studio was started anew. Open the address it printed: then this tab goes on, too.`,Ui=[`preview`,`compare`],Wi=[`video`,`versions`,`clips`,`export`],Gi=class{api;store;state=z(null);trouble=z(null);opening=z(null);unread=z(null);videoWithoutPoses=z(null);question=B(()=>{let{people:e=[],name:t}=this.unread.value??{},n=`${e.length} people are in ${t}: choose one of them on the left, or all.`;return e.length>1?n:``});notifications;recordings=z([]);list=new zi(this.state,this.recordings);edited=B(()=>{let e=this.store.recording.value?.id;return this.recordings.value.find(t=>t.id===e)});blocked=B(()=>this.recordings.value.filter(e=>e.blocked.value));unsent=B(()=>this.recordings.value.flatMap(e=>e.describeUnsent()));segmenting=B(()=>{let{edited:e}=this;return!!(e.value?.busy.value||e.value?.confirmed.value.finding)||this.comparisons.draft.value!==null});comparisons;people;missedRevisions=new Map;retryTimer=0;hasStarted=!1;constructor(e,t){this.api=e,this.store=t,this.notifications=new Fi(()=>Ki(t.recording.value)),this.comparisons=new bi(this),this.people=new xi(this);let n=(e,t)=>void ct(()=>{t(),We(()=>e.forEach(e=>this.notifications.clearProblem(e)))});n(Ui,()=>Ki(t.recording.value)),n(Wi,()=>t.recording.value?.id)}async start(e){xr(this.api);let[t]=await Promise.all([this.refresh(),e]);t&&await this.openInitial()}async refresh(){try{return this.state.value=await this.api.loadState(),this.notifications.clearProblem(`folder`),!0}catch(e){return e instanceof fr?this.handleLostConnection():e instanceof dr&&e.status===403?this.handleLostConnection(Hi):this.notifications.reportProblem(hr(e),`folder`),!1}}async open(e,{beside:t=!1,shown:n=()=>void 0}={}){let{store:r}=this;if(this.opening.value===e)return;let i=r.findIndex(e);if(i>=0)r.show(i),this.notifications.clearProblem(`open`),t||this.closeOthers(e,r.people.value),n();else{this.opening.value=e,this.unread.value=null,this.videoWithoutPoses.value=null;try{let i=await this.loadOpened(e);if(this.opening.value!==e)return;t||(r.playhead.value=0),r.add(i),t||this.closeOthers(e),n(),this.notifications.clearProblem(`open`),this.refresh(),await _i(i)}catch(t){if(this.opening.value!==e&&r.findIndex(e)<0)return;if(mr(t)){this.videoWithoutPoses.value=e,this.notifications.clearProblem(`open`),this.refresh();return}let n=this.handleUnread(e,t);(!n||r.opened.value.length)&&this.notifications.reportProblem(n?this.question.value:hr(t),`open`)}finally{this.opening.value===e&&(this.opening.value=null)}}}async readAs(e,t){let n;try{n=await this.api.readAs(e,t)}catch(t){let n=this.handleUnread(e,t);this.notifications.clearProblem(`open`),this.notifications.reportProblem(n?this.question.value:hr(t),`reading`);return}for(let e of[`reading`,`open`])this.notifications.clearProblem(e);let{value:r}=this.store.recording,i=(r?.id===e?this.store.people.value:[]).map(e=>e.recording.value.id),a=n.length===1&&n[0]===e;for(let t of[e,...i])this.close(t);await this.refresh(),await this.openTogether(a&&i.length?i:n)}async openTogether(e){for(let[t,n]of e.entries())await this.open(n,{beside:t>0});let t=this.store.findIndex(e[0]);e.length>1&&t>=0&&this.store.show(t)}handleUnread(e,t){let n=pr(t),r=this.state.value?.recordings.find(t=>t.id===e)?.name,i=this.unread.value?.id===e?this.unread.value.people:[];return n&&r&&(this.unread.value={id:e,name:r,people:n.length?n:i}),(n?.length??0)>1&&this.question.value!==``}async openNext(e){let{value:t}=this.list.listed,n=this.opening.value??this.store.recording.value?.id,r=t.findIndex(e=>e.id===n),i=r<0?t[0]:t[r+e];i?await this.open(i.id):this.notifications.tell(e>0?`This is the last recording.`:`This is the first recording.`)}close(e){let t=this.store.findIndex(e);t>=0&&this.store.close(t),this.forgetClosed()}stopOpening(){this.opening.value=null}cancel(){this.comparisons.cancel();let{value:e}=this.edited;e?.cancel(),e?.confirmed.value.being_read&&this.close(e.id)}handleLostConnection(e=Vi){this.trouble.value=e,this.retryTimer||=window.setInterval(()=>void this.recover(),sr)}async recover(){if(await this.refresh()){if(window.clearInterval(this.retryTimer),this.retryTimer=0,this.trouble.value=null,!this.hasStarted)await this.openInitial();else for(let e of this.recordings.value)await e.resume(),await this.renewMotion(e.id)}}async openInitial(){this.hasStarted=!0,this.api.listen(e=>void this.handleChange(e),e=>void(e?this.recover():this.refresh())),addEventListener(`focus`,()=>void this.refresh());let{recordings:e}=this.state.value,t=new Set(e.map(e=>e.id)),n=nr().filter(e=>t.has(e)),r=new Set(e.map(e=>e.file));if(n.length||r.size!==1)for(let e of n)await this.open(e,{beside:!0});else await this.openTogether([...t]);rr()&&this.store.seek(rr()),ct(()=>ir(this.store.opened.value))}async loadOpened(e){let t=new ur(this.api,e),n=this.recordings.value.find(t=>t.id===e)??await Ti.open(e,{api:this.api,folder:this.state.value?.folder??``,isOffline:()=>this.trouble.peek()!==null,onConnectionLost:()=>this.handleLostConnection(),tell:(t,n)=>this.notifications.tell(this.addName(e,t),n),warn:t=>this.notifications.reportProblem(this.addName(e,t),`edit`)});if(!this.recordings.value.includes(n)){this.recordings.value=[...this.recordings.value,n];let t=this.missedRevisions.get(e)??0;t>n.confirmed.peek().revision&&n.handleChange(t),this.missedRevisions.delete(e)}return{data:t,recording:n.confirmed,motion:z(null),keypoints:z(null)}}addName(e,t){let n=this.recordings.peek().find(t=>t.id===e);return!n||this.edited.peek()===n?t:`${n.confirmed.peek().name}: ${t}`}forgetClosed(){let e=new Set(this.store.opened.value.map(e=>e.recording.peek().id)),[t,n]=[[],[]];for(let r of this.recordings.value)(e.has(r.id)||r.hasPending()?t:n).push(r);for(let e of n)e.close();n.length&&(this.recordings.value=t)}closeOthers(e,t=[]){for(let n of this.store.opened.value)n.recording.value.id!==e&&!t.includes(n)&&this.close(n.recording.value.id)}async handleChange(e){let t=this.recordings.value.find(t=>t.id===e.recording);t?(await t.handleChange(e.revision),await this.renewMotion(t.id)):(this.missedRevisions.set(e.recording,e.revision),await this.refresh())}async renewMotion(e){let t=this.store.opened.value[this.store.findIndex(e)];try{t?.motion.value&&await _i(t)}catch(e){this.notifications.reportProblem(hr(e),`open`)}}};function Ki(e){return e?`${e.id} ${e.revision}`:``}var qi=Symbol.for(`pv`),Ji=0;Array.isArray;function U(t,n,r,i,a,o){n||={};var s,c,l=n;if(`ref`in l&&typeof t!=`function`)for(c in l={},n)c==`ref`?s=n[c]:l[c]=n[c];var u={type:t,props:l,key:r,ref:s,__k:null,__:null,__b:0,__e:null,__c:null,constructor:qi,__v:--Ji,__i:-1,__u:0};return(a||o)&&(u.__source=a,u.__self=o),e.vnode&&e.vnode(u),u}var Yi=matchMedia(`(prefers-color-scheme: dark)`),Xi=z(Yi.matches?`dark`:`light`),Zi=z(null),Qi=z(!1);Yi.addEventListener(`change`,()=>Xi.value=Yi.matches?`dark`:`light`);var $i=B(()=>Qi.value?`light`:Zi.value??Xi.value);ct(()=>document.documentElement.setAttribute(`data-theme`,$i.value));function ea(){Zi.value=$i.value===`dark`?`light`:`dark`}function W(e){let t=`${$i.value} ${e}`,n=ta.get(t);if(n===void 0){let r=document.documentElement;r.style.outlineColor=`var(--${e})`,na??=new OffscreenCanvas(1,1).getContext(`2d`),na.fillStyle=getComputedStyle(r).outlineColor,n=String(na.fillStyle),ta.set(t,n)}return n}var ta=new Map,na=null,ra=new class{drawn=0;tasks=new Set;times=[];pending=0;last=0;add(e){return this.tasks.add(e),this.request(),()=>this.tasks.delete(e)}request(){this.pending===0&&(this.pending=requestAnimationFrame(e=>this.run(e)))}drawNow(){cancelAnimationFrame(this.pending),this.run(performance.now())}measureRate(e=performance.now()){return this.times.filter(t=>e-t<=1e3).length}run(e){this.pending=0;let t=Math.min(Math.max((e-this.last)/1e3,0),.5);this.last=e,this.times.push(e),this.times.length>240&&this.times.splice(0,120),this.drawn+=1;for(let e of this.tasks)e(t)}};function ia(e,t){let n=!0,r=ra.add(e=>{n&&(n=!1,t(e))}),i=ct(()=>{e(),n=!0,ra.request()});return()=>{i(),r()}}function aa({label:e,watch:t,draw:n,gestures:r,...i}){let a=R(null),o=R({watch:t,draw:n});return o.current={watch:t,draw:n},I(()=>{let e=a.current,t=z({width:0,height:0}),n=new ResizeObserver(()=>{t.value={width:e.clientWidth,height:e.clientHeight}});n.observe(e);let r=ia(()=>{$i.value,t.value,o.current.watch()},()=>oa(e,t.value,o.current.draw));return()=>{r(),n.disconnect()}},[]),I(()=>{if(r)return Mt(a.current,{pointerdown:e=>r.down(e),pointermove:e=>r.move(e),pointerup:e=>r.up(e),pointercancel:()=>r.cancel(),pointerleave:()=>r.leave(),wheel(e){e.preventDefault(),r.wheel(e)}},{passive:!1})},[r]),U(`canvas`,{ref:a,role:`img`,"aria-label":e,...i})}function oa(e,{width:t,height:n},r){if(t===0||n===0)return;let i=devicePixelRatio,[a,o]=[Math.round(t*i),Math.round(n*i)];(e.width!==a||e.height!==o)&&([e.width,e.height]=[a,o]);let s=e.getContext(`2d`,{willReadFrequently:!0});s.setTransform(i,0,0,i,0,0),s.clearRect(0,0,t,n),r(s,t,n)}function sa({share:e,horizontal:t=!1,handle:n=!1}){if(!(e>=0&&e<=1))return null;let r=t?`translateY(${100*e}cqh)`:`translateX(${100*e}cqw)`;return U(`div`,{class:`line ${`${t?`horizontal`:`vertical`}${n?` handle`:``}`}`,style:{transform:r}})}var ca=100;function la(e,t){let n=Oe(()=>z(e.peek()),[e]);return I(()=>{let r=-1/0;return ct(()=>{let i=e.value,a=performance.now();t.value&&a-r<ca||(r=a,n.value=i)})},[e,t,n]),n}function ua(e){let{left:t,top:n}=e.currentTarget.getBoundingClientRect();return{x:e.clientX-t,y:e.clientY-n}}function da(e){return Math.exp(.0015*e.deltaY)}var fa=24;function pa(e,t,n){if(!e.has(t))return null;let r=ma(e);e.set(t,n);let i=ma(e);return!r||!i?null:{from:r.middle,to:i.middle,factor:r.length/i.length}}function ma(e){let[t,n]=e.values();return!t||!n?null:{middle:{x:(t.x+n.x)/2,y:(t.y+n.y)/2},length:Math.max(Math.hypot(t.x-n.x,t.y-n.y),fa)}}var ha=`11px system-ui, sans-serif`;function ga(e,t,n){if(e.measureText(t).width<=n)return t;for(let r=t.length-1;r>=3;r--){let i=t.slice(0,r)+`…`;if(e.measureText(i).width<=n)return i}return``}function _a(e){let t=document.createElement(`canvas`);t.width=t.height=6;let n=t.getContext(`2d`);n.strokeStyle=W(`hatch`),n.lineWidth=1.2;for(let e of[-6,0,6])n.moveTo(e,6),n.lineTo(e+6,0);return n.stroke(),e.createPattern(t,`repeat`)??W(`hatch`)}function va(e,t,n){e.save(),e.beginPath(),e.rect(...t),e.clip(),n(),e.restore()}function ya(e,t){e.beginPath();let n=!1;for(let r of t)r&&n?e.lineTo(...r):r&&e.moveTo(...r),n=r!==null;e.stroke()}function G(e){let{busy:t=!1,children:n,...r}=e;return U(`button`,{type:`button`,...r,children:[n,t&&U(`span`,{class:`busy`})]})}function ba({on:e,...t}){return U(G,{"aria-pressed":e.value,onClick:()=>void(e.value=!e.value),...t})}function xa({onSubmit:e,...t}){return U(`form`,{...t,onSubmit:t=>{t.preventDefault(),e()}})}function Sa(e){return U(`label`,{class:`field`,title:e.tooltip,children:[U(`span`,{children:e.title}),e.children]})}function Ca(e){let{label:t,title:n=t,onClick:r}=e;return U(G,{class:`icon`,"aria-label":t,title:n,onClick:r,children:`×`})}function wa({color:e}){return U(`span`,{class:`swatch`,style:{background:e??`#DDDDDD`}})}function Ta({value:e,...t}){return U(`input`,{type:`text`,...t,value:e.value,onInput:t=>e.value=t.currentTarget.value})}function Ea(e){let{label:t,value:n,options:r,onSelect:i}=e;return U(`select`,{...t&&{"aria-label":t},value:n,onChange:({currentTarget:e})=>i(r[e.selectedIndex][0]),children:r.map(([e,t])=>U(`option`,{value:e,children:t},e))})}function Da(e){let{checked:t,title:n,onCheck:r,children:i}=e;return U(`label`,{class:`check`,...n&&{title:n},children:[U(`input`,{type:`checkbox`,checked:t,onChange:e=>r(e.currentTarget.checked)}),i]})}function Oa(e){let{name:t,value:n,options:r,onSelect:i}=e;return U(`fieldset`,{children:r.map(([e,r,a=!1])=>U(`label`,{class:`check`,children:[U(`input`,{type:`radio`,name:t,checked:n===e,disabled:a,onChange:()=>i(e)}),r]},e))})}function ka(e){let{title:t,close:n,children:r}=e,i=R(null);return L(()=>i.current?.showModal(),[]),U(`dialog`,{ref:i,"aria-label":t,onClose:n,onClick:e=>e.target===i.current&&n(),children:U(`div`,{class:`dialog-body`,children:[U(`div`,{class:`panel-head`,children:[U(`h1`,{children:t}),U(`span`,{class:`spacer`}),U(Ca,{label:`Close`,onClick:n})]}),r]})})}function Aa(){let e=V(``);return[e.value,async(t,n)=>{e.value=t;try{await n()}finally{e.value=``}}]}function ja(e){let{name:t,busy:n,work:r,...i}=e;return U(G,{disabled:n!==``,busy:n===t,onClick:()=>void r(),...i,children:t})}function Ma(e,t){let n=new Set(e);return n.delete(t)||n.add(t),n}function Na(e,t){let n=V(null),r=R({value:e,onText:t}),i=()=>{let e=n.value;e!==null&&e!==r.current.value&&(r.current.value=e,r.current.onText(e))};return{value:n.value??e,onFocus:i=>{r.current={value:e,onText:t},n.value=i.currentTarget.value},onInput:e=>n.value=e.currentTarget.value,onChange:i,onBlur:()=>{i(),n.value=null},onKeyDown:e=>{let t=e.currentTarget instanceof HTMLTextAreaElement;e.key===`Escape`&&(n.value=null),(e.key===`Escape`||e.key===`Enter`&&(!t||e.ctrlKey))&&e.currentTarget.blur()}}}function Pa({value:e,field:t,onName:n,onDone:r,...i}){let a=Na(e,t=>t.trim()!==e&&n(t.trim()));return U(`input`,{ref:t??null,type:`text`,placeholder:`no name`,...i,...a,onBlur:()=>{a.onBlur(),r?.()}})}function Fa({value:e,onNumber:t,...n}){let r=Na(String(e),e=>{let n=Number(e);e.trim()&&Number.isFinite(n)&&t(n)});return U(`input`,{...n,type:`number`,class:`number`,...r})}var Ia={play:`M4 2.5v11l9-5.5z`,pause:`M4 2.5h3v11H4zM9 2.5h3v11H9z`,back:`M11.5 2.5v11L4.5 8z`,on:`M4.5 2.5v11l7-5.5z`,before:`M2.5 2.5h2v11h-2zM13 2.5v11L5.5 8z`,after:`M11.5 2.5h2v11h-2zM3 2.5v11l7.5-5.5z`,loop:`M4 4.5h6.5V2l4 3.5-4 3.5V6.5H5.5v2h-2V5zM12 11.5H5.5V14l-4-3.5 4-3.5v2.5h5v-2h2V11z`,minus:`M3 7h10v2H3z`,plus:`M7 3h2v4h4v2H9v4H7V9H3V7h4z`,fit:`M2 3h2v10H2zM12 3h2v10h-2zM5 8l2.5-2.5v1.7h1V5.5L11 8l-2.5 2.5V8.8h-1v1.7z`,full:`M2 2h5v2H4v3H2zM9 2h5v5h-2V4H9zM2 9h2v3h3v2H2zM12 9h2v5H9v-2h3z`,theme:`M8 2a6 6 0 1 0 0 12zM8 2a6 6 0 1 1 0 12v-1.4a4.6 4.6 0 1 0 0-9.2z`};function La({icon:e,label:t,keys:n,pressed:r,onClick:i}){return U(G,{class:`icon`,"aria-label":t,title:n?`${t} (${n})`:t,onClick:i,...r!==void 0&&{"aria-pressed":r},children:U(`svg`,{width:`16`,height:`16`,viewBox:`0 0 16 16`,fill:`currentColor`,"aria-hidden":`true`,children:U(`path`,{d:Ia[e]})})})}function Ra(){return U(La,{icon:`theme`,label:`Show the page ${$i.value===`dark`?`light`:`dark`}`,onClick:ea})}function za(){let e=Pn().levels.value;if(!e||e.all.length<2)return null;let{all:t,detail:n,choose:r}=e,i=n===1?`as usual`:n<1?`coarser`:`finer`;return U(`label`,{class:`detail`,title:`How fine the segments are (comma coarser, full stop finer)`,children:[U(`span`,{children:[`Detail `,U(`span`,{class:`quiet`,children:i})]}),U(`span`,{class:`number`,children:Number(n.toFixed(3))}),U(`input`,{type:`range`,"aria-label":`Detail`,"aria-valuetext":`${n}, ${i}`,min:0,max:t.length-1,step:1,value:An(n,t),onInput:e=>r(t[e.currentTarget.valueAsNumber])})]})}var Ba=6;function Va({class:e,caption:t,columns:n,rows:r}){return U(`table`,{class:e,children:[t&&U(`caption`,{children:t}),n&&U(`thead`,{children:U(`tr`,{children:n.map(e=>{let[t,n]=typeof e==`string`?[e]:e;return U(`th`,{scope:t?`col`:void 0,title:n,children:t},t)})})}),U(`tbody`,{children:r.map(({key:e,head:t,cells:n,...r})=>U(`tr`,{...r,children:[t!==void 0&&U(`th`,{scope:`row`,children:t}),n.map((e,t)=>U(`td`,{children:e},t))]},e))})]})}function Ha(e){let t=R(null),n=V(0),r=V(600);return I(()=>{let e=t.current,n=new ResizeObserver(()=>r.value=e.clientHeight);return n.observe(e),()=>n.disconnect()},[r]),{ref:t,onScroll:()=>void(n.value=t.current.scrollTop),from:Math.max(Math.floor(n.value/e)-Ba,0),to:Math.ceil((n.value+r.value)/e)+Ba}}function Ua(e){let{order:t,column:n,title:r,tooltip:i}=e,[a,o]=t.value;return U(G,{class:`plain`,title:i,onClick:()=>t.value=[n,a===n&&!o],children:[r,a===n&&(o?` ▾`:` ▴`)]})}function Wa(){let e=Pn(),t=e.recording.value;if(!t)return null;let{provenance:n,timings:r}=t.segmentation,{notes:i,parameters:a,...o}=n;return U(`div`,{class:`about`,children:[U(`dl`,{children:[U(Ka,{name:`Recording`,children:t.name}),U(Ka,{name:`Length`,children:[pn(e.duration.value,2),` (`,t.n_frames,` frames at`,` `,Za(t.fps),` Hz)`]}),U(Ka,{name:`Found`,children:Rt(t.segmentation)}),Object.entries(o).map(([e,t])=>U(Ka,{name:e,children:U(qa,{value:t})},e))]}),U(Ja,{title:`Warnings`,sentences:t.warnings}),U(Ja,{title:`Notes`,sentences:Array.isArray(i)?i.map(String):[]}),U(Ya,{timings:r}),Xa(a)&&U(`details`,{children:[U(`summary`,{children:`Parameters`}),U(qa,{value:a})]})]})}function Ga(e){let t=e.recording.value?.warnings.length??0;return t?`About ⚠ ${t}`:`About`}function Ka({name:e,children:t}){return U(S,{children:[U(`dt`,{children:e}),U(`dd`,{children:t})]})}function qa({value:e}){return Xa(e)?U(`dl`,{children:Object.entries(e).map(([e,t])=>U(Ka,{name:e.replaceAll(`_`,` `),children:U(qa,{value:t})},e))}):Array.isArray(e)?U(S,{children:e.map(e=>String(e)).join(`, `)}):e===null?U(S,{children:`none`}):typeof e==`string`?U(S,{children:e}):U(S,{children:typeof e==`number`?Za(e):JSON.stringify(e)})}function Ja(e){let{title:t,sentences:n}=e;return n.length===0?null:U(`section`,{children:[U(`h2`,{children:t}),U(`ul`,{children:n.map(e=>U(`li`,{children:e},e))})]})}function Ya({timings:e}){let t=Object.entries(e);if(t.length===0)return null;let n=Math.max(...t.map(([,e])=>e),1e-9);return U(`section`,{children:[U(`h2`,{children:[`Timings, `,t.reduce((e,[,t])=>e+t,0).toFixed(2),` s in all`]}),U(Va,{class:`timings`,rows:t.map(([e,t])=>({key:e,head:e,cells:[U(`span`,{class:`number`,children:[t.toFixed(3),` s`]}),U(`span`,{class:`timing-bar`,style:{width:`${100*t/n}%`}})]}))})]})}function Xa(e){return typeof e==`object`&&!!e&&!Array.isArray(e)}function Za(e){return String(Number(e.toPrecision(6)))}function Qa({keys:e}){return U(Va,{class:`keys`,rows:e.map(([e,t])=>({key:e,head:U(`kbd`,{children:e}),cells:[t]}))})}var $a=4,eo=7,to=.1,no=new Set,ro={level:null,differences:no,person:null,isActive:!1,above:0};function io(e,t){let{people:n=[]}=e,r=n.length?n.flatMap((t,n)=>ao(t,e,n?eo:0)):oo(e),i=r.reduce((e,t)=>e+t.share,0),a=r.reduce((e,t)=>e+$a+t.above,0),o=Math.max(t-22-a,0),s=22;return r.map(({share:e,above:t,...n})=>{s+=t;let r={...n,top:s,height:Math.min(o*e/i,44*e)};return s+=r.height+$a,r})}function ao(e,t,n){let{name:r,index:i,segmentation:a}=e;return a?[`activity`,`primitive`].map(e=>({...ro,person:i,id:`person-${i}-${e}`,title:``,segments:zt(a,e),share:.8})).filter(({segments:e},t)=>!t||e.length).map((e,t)=>t?e:{...e,title:r,above:n}):oo(t).map((e,t)=>t?e:{...e,title:r,isActive:!0,above:n})}function oo({activities:e,primitives:t,labels:n,others:r}){let i=r.map(({name:e,segmentation:t,marked:n})=>({name:e,marked:n,activity:zt(t,`activity`),primitive:zt(t,`primitive`)})),a=i.find(e=>e.marked),o=(e,t)=>t?so(e,t):no,s=(e,t,n,r,i={})=>({...ro,id:e,title:t,segments:n,share:r,...i}),c=[s(`activity`,`Activities`,e,1,{level:`activity`,differences:o(e,a?.activity)}),s(`primitive`,`Primitives`,t,1.2,{level:`primitive`,differences:o(t,a?.primitive)}),s(`label`,`Labels`,n,.7)];return i.forEach(({name:n,marked:r,activity:a,primitive:l},u)=>{let d=o(a,r?e:void 0);if(c.push(s(`other-activity-${u}`,n,a,.8,{differences:d})),i.length>1&&!l.length)return;let f=o(l,r?t:void 0);c.push(s(`other-primitive-${u}`,``,l,.8,{differences:f}))}),c}function so(e,t){let n=({start_s:e})=>{let n=Jt(t,t=>t.start_s<e-to);return n<t.length&&t[n].start_s<=e+to};return new Set(e.filter(e=>!n(e)).map(e=>e.start_frame))}function co(e,t){return e.find(e=>t>=e.top&&t<e.top+e.height)}function lo(e,t,n){let r=Jt(e,e=>e.stop_s<t);return[r,Jt(e,e=>e.start_s<=n,r)]}function uo(e,t,n,r){let[i,a]=lo(e,t.start_s,t.stop_s),o=-1/0;for(let s of e.slice(i,a)){let e=an(t,n,s.start_s),i=an(t,n,s.stop_s);i-o<.5||(o=i,r(s,e,i))}}function fo(e,t,n,r){let i=qt(e,Math.floor(t*r)),a=e[i]?Zt(e[i])/3:0,o=[e[i],e[i+1]].filter(e=>e!==void 0&&e.start_frame>0).map(e=>({frame:e.start_frame,far:Math.abs(e.start_s-t)})).sort((e,t)=>e.far-t.far)[0];return o&&o.far<Math.min(n,a)?o.frame:null}function po(e,t,n){let r=qt(e,t),i=e[r-1]?.start_frame??0,a=e[r]?.stop_frame??t;return[Math.min(i+n,t),Math.max(a-n,t)]}var mo=3;function ho(e,t,n,r){let i=n.range.value,a=r-78;e.font=ha,e.textBaseline=`middle`,go(e,i,a);let o={range:i,plotWidth:a,hatch:_a(e),store:n};for(let n of t)Oo(e,n),va(e,[78,n.top-2,a,n.height+4],()=>{e.translate(78,0),e.fillStyle=W(`lane`),e.fillRect(0,n.top,a,n.height),vo(e,n,o),xo(e,n,o),Co(e,n,o)});Eo(e,n.loop.value,i,a),Do(e,n,i,a)}function go(e,t,n){e.fillStyle=W(`quiet`),e.strokeStyle=W(`line`),e.lineWidth=1;for(let{seconds:r,label:i}of fn(t,n)){let a=Math.round(78+an(t,n,r))+.5;a>78+n-1||(e.beginPath(),e.moveTo(a,16),e.lineTo(a,21),e.stroke(),a<78+n-34&&e.fillText(i,a+4,10))}}function _o(e,t,n,r){let i={start_s:0,stop_s:r.duration.value};e.fillStyle=W(`lane`),e.fillRect(0,0,t,n);for(let a of r.activities.value){let o=an(i,t,a.start_s),s=an(i,t,a.stop_s);e.fillStyle=r.getColor(a)??`transparent`,e.fillRect(o,2,Math.max(s-o,.5),n-4)}let{start_s:a,stop_s:o}=r.range.value,s=an(i,t,a),c=an(i,t,o);e.globalAlpha=.6,e.fillStyle=W(`page`),e.fillRect(0,0,s,n),e.fillRect(c,0,t-c,n),e.globalAlpha=1,e.strokeStyle=W(`quiet`),e.strokeRect(s+.5,.5,Math.max(c-s-1,2),n-1)}function vo(e,t,{range:n,plotWidth:r,hatch:i,store:a}){let o=To(t,a.drag.value,a.fps.value),s=a.hovered.value;uo(o,n,r,(n,o,c)=>{let l=a.getColor(n),u=c-o>3,d=u?.75:0;e.fillStyle=l??i,wo(e,o+d,t.top,Math.max(c-o-2*d,1),t.height),e.fill();let f=s!==null&&t.person===null&&n.cluster===s;(u||f)&&(e.strokeStyle=W(f?`accent`:`edge`),e.lineWidth=f?2:.75,e.stroke()),l&&c-o>16&&(e.fillStyle=bn(l),So(e,t,n,Math.max(o,0),Math.min(c,r))),t.level&&n.checked&&c-o>8&&yo(e,t,c),t.level&&n.excluded&&bo(e,t,o,c)})}function yo(e,t,n){e.fillStyle=W(`panel`),e.strokeStyle=W(`text`),e.lineWidth=1.5;let[r,i]=[n-8,t.top+t.height-6];e.beginPath(),e.roundRect(r-2,i-2,9,7,2),e.fill(),e.beginPath(),e.moveTo(r,i+1),e.lineTo(r+2,i+3),e.lineTo(r+5,i-1),e.stroke()}function bo(e,t,n,r){e.strokeStyle=W(`panel`),e.lineWidth=2,e.beginPath(),e.moveTo(n+1,t.top+t.height),e.lineTo(r-1,t.top),e.stroke()}function xo(e,t,{range:n,plotWidth:r,store:i}){e.fillStyle=W(`danger`);for(let a of t.differences){let o=an(n,r,a/i.fps.value);o<-2||o>r+2||e.fillRect(o-1.5,t.top-2,3,t.height+4)}}function So(e,t,n,r,i){let{label:a,cluster:o}=n,s=ga(e,a||(o>=0?String(o):$t(n)),i-r-9);s&&e.fillText(s,r+5,t.top+t.height/2+.5)}function Co(e,t,{range:n,plotWidth:r,store:i}){let a=i.edit.value?i.target.value:i.selected.value;if(!a||t.level!==a.level)return;let o=an(n,r,a.start_s),s=an(n,r,a.stop_s);e.strokeStyle=W(`text`),e.lineWidth=2,e.setLineDash(i.selected.value?[]:[4,3]),wo(e,o,t.top-.5,Math.max(s-o,2),t.height+1),e.stroke(),e.setLineDash([]);let c=i.edit.value&&i.border.value;if(!c)return;let l=an(n,r,c.start_s);e.fillStyle=W(`text`);for(let[n,r]of[[t.top+5,t.top-2],[t.top+t.height-5,t.top+t.height+2]])e.beginPath(),e.moveTo(l,n),e.lineTo(l-4,r),e.lineTo(l+4,r),e.fill()}function wo(e,t,n,r,i){e.beginPath(),r<6?e.rect(t,n,r,i):e.roundRect(t,n,r,i,mo)}function To(e,t,n){if(t?.lane!==e.id)return e.segments;let{frame:r,to:i}=t;return e.segments.map(e=>{let t={...e,checked:!1};return e.start_frame===r?{...t,start_frame:i,start_s:i/n}:e.stop_frame===r?{...t,stop_frame:i,stop_s:i/n}:e})}function Eo(e,t,n,r){if(!t)return;let i=Math.max(an(n,r,t.start_s),0),a=Math.min(an(n,r,t.stop_s),r);a<=i||(e.fillStyle=W(`accent`),e.fillRect(78+i,18,a-i,3))}function Do(e,t,n,r){e.fillStyle=W(`accent`);let{start_s:i,stop_s:a}=t.bounds.value;for(let[t,o]of[[i,1],[a,-1]]){if(t===null)continue;let i=an(n,r,t);i<0||i>r||(e.fillRect(78+i-1,2,2,18),e.fillRect(78+(o>0?i:i-6),2,6,2),e.fillRect(78+(o>0?i:i-6),18,6,2))}}function Oo(e,t){e.font=t.isActive?`bold ${ha}`:ha,e.fillStyle=W(t.isActive?`text`:`quiet`);let n=ga(e,t.title,64);e.fillText(n,10,t.top+t.height/2+.5),e.font=ha}var ko=3,Ao=4,jo=2e3;function Mo(e,t,n,r,{width:i,height:a,ruler:o}){let s=Math.max(Math.floor(i-78),1),c=o?22:2,l=(a-c)/Math.max(t.length,1);e.font=ha,e.textBaseline=`middle`,o&&go(e,r.range.value,s),t.forEach(({curve:t,head:i},a)=>{let o={top:c+a*l,height:Math.max(l-ko,1),plotWidth:s};Po(e,i,o),va(e,[78,o.top,s,o.height],()=>{e.translate(78,0),Fo(e,r,o),Io(e,t,n,r,o)})})}var No=class{data;list;loadCount=z(0);cache=new jt(jo);constructor(e,t){this.data=e,this.list=t}get(e,t,n){let r=`${e} ${t} ${n}`,i=this.cache.get(r);return i===void 0?(this.cache.set(r,null),this.data.loadCurveTile(e,t,n).then(e=>{this.cache.set(r,new Float32Array(e??new ArrayBuffer(0))),this.loadCount.value+=1},()=>this.cache.delete(r)),null):i}getBounds(e){let t=this.get(e,this.list.levels-1,0);if(!t)return null;let n=t.filter(e=>!Number.isNaN(e)),[r,i]=[1/0,-1/0];for(let e of n)[r,i]=[Math.min(r,e),Math.max(i,e)];return n.length?[r,i]:[0,1]}getValue(e,t){let{tile:n}=this.list,r=this.get(e,0,Math.floor(t/n));return r?.length?r[t%n*2]??NaN:null}};function Po(e,{name:t,group:n,unit:r},{top:i,height:a}){let o=a>26,s=i+a/2;e.fillStyle=W(`text`),e.fillText(ga(e,t,64),10,o?s-7:s),e.fillStyle=W(`quiet`);let c=n===`channels`?r:`${n}${r?`, ${r}`:``}`;o&&e.fillText(ga(e,c,64),10,s+7)}function Fo(e,t,{top:n,height:r,plotWidth:i}){e.fillStyle=W(`lane`),e.fillRect(0,n,i,r),uo(t.primitives.value.length?t.primitives.value:t.activities.value,t.range.value,i,(i,a,o)=>{e.globalAlpha=.16,e.fillStyle=t.getColor(i)??`transparent`,e.fillRect(a,n,o-a,r),e.globalAlpha=1,e.fillStyle=W(`line`),o-a>4&&e.fillRect(Math.round(a),n,1,r)})}function Io(e,t,n,r,i){let a=n.getBounds(t);if(!a)return;let[o,s]=a[0]<a[1]?a:[a[0]-1,a[1]+1],c=(i.height-8)/(s-o),l=e=>i.top+i.height-Ao-(e-o)*c;o<0&&s>0&&(e.fillStyle=W(`line`),e.fillRect(0,Math.round(l(0)),i.plotWidth,1)),e.strokeStyle=W(`text`),e.lineWidth=1.2,e.lineJoin=`round`,Ro(e,Lo(t,n,r,i.plotWidth),l)}function Lo(e,t,n,r){let{factor:i,levels:a,tile:o}=t.list,s=n.range.value,c=n.fps.value,l=n.recording.value?.n_frames??0,u=(s.stop_s-s.start_s)*c/r,d=n=>{let a=i**n,u=Math.ceil(l/a),d=-1,p=null;return Bo(r=>{Math.floor(r/o)!==d&&(d=Math.floor(r/o),p=t.get(e,n,d),p?.length||(f=!0));let i=2*(r-d*o);return p?.length?[p[i],p[i+1]]:null},u,c/a,s,r)},f=!1,p=d(zo(u,i,a));if(!f)return p;let m=d(a-1);return{low:p.low.map((e,t)=>Number.isNaN(e)?m.low[t]:e),high:p.high.map((e,t)=>Number.isNaN(e)?m.high[t]:e)}}function Ro(e,{low:t,high:n},r){ya(e,Array.from(t,(e,t)=>{if(Number.isNaN(e))return[null];let i=[e,n[t]].map(e=>[t+.5,r(e)]);return i[1][1]+=e===n[t]?.01:0,t%2?i:i.reverse()}).flat())}function zo(e,t,n){let r=Math.floor(Math.log(Math.max(e,1))/Math.log(t)+1e-9);return Math.min(r,n-1)}function Bo(e,t,n,r,i){let a=new Float32Array(i).fill(NaN),o=new Float32Array(i).fill(NaN),s=(r.stop_s-r.start_s)*n/i,c=r.start_s*n;for(let n=0;n<i;n++){let r=c+n*s,i=r+s;if(s<1){let i=Vo(e,t,r+.5*s);a[n]=o[n]=i}else for(let s=Math.max(Math.floor(r),0);s<Math.min(Math.ceil(i),t);s++){let t=e(s);t&&!Number.isNaN(t[0])&&(a[n]=Number.isNaN(a[n])?t[0]:Math.min(a[n],t[0]),o[n]=Number.isNaN(o[n])?t[1]:Math.max(o[n],t[1]))}}return{low:a,high:o}}function Vo(e,t,n){let r=Math.floor(n);if(r<0||r>t-1)return NaN;let i=e(r)?.[0]??NaN,a=e(Math.min(r+1,t-1))?.[0]??NaN,o=n-r;return o<1e-6||Number.isNaN(a)?i:i+o*(a-i)}function Ho(){let e=Pn(),t=R([]),n=Oe(()=>new Yo(e,()=>t.current),[e]);I(()=>Mt(window,{keydown:e=>{e.key===`Escape`&&n.cancelDrag()&&e.stopPropagation()}},{capture:!0}),[n]);let r=()=>({activities:e.activities.value,primitives:e.primitives.value,labels:e.labels.value,others:e.others.value,people:e.people.value.map(({recording:{value:t}})=>({name:gi(t.person??t.name),index:e.findIndex(t.id),segmentation:t.id===e.recording.value?.id?null:t.segmentation}))});return U(`div`,{class:`timeline`,children:[U(`div`,{class:`lanes`,children:[U(aa,{label:`Segments over time. Click one to go there; use the wheel or two fingers to zoom, drag to pan.`,watch:()=>{r(),e.range.value,e.selected.value,e.hovered.value,e.loop.value,e.drag.value,e.target.value,e.border.value,e.bounds.value,e.labelColors.value,e.edit.value,e.table.value},draw:(n,i,a)=>{t.current=io(r(),a),ho(n,t.current,e,i)},gestures:n}),U(Uo,{handle:!0})]}),U(Go,{}),U(Wo,{})]})}function Uo({handle:e=!1}){let t=Pn();return U(`div`,{class:`playhead-room`,style:{left:`78px`},children:U(sa,{share:an(t.range.value,1,t.playhead.value),handle:e})})}function Wo(){let e=Pn().selected.value;return U(`p`,{class:`unseen`,role:`status`,children:e&&`${e.level} ${$t(e)}, from ${pn(e.start_s,2)}, ${Zt(e).toFixed(2)} seconds`})}function Go(){let e=Pn(),t=t=>{if(!t.currentTarget.hasPointerCapture(t.pointerId))return;let{left:n,width:r}=t.currentTarget.getBoundingClientRect(),{start_s:i,stop_s:a}=e.range.value,o=(t.clientX-n)/r*e.duration.value;e.zoom.value?e.panBy(o-(i+a)/2):e.seek(o)};return U(`div`,{class:`overview`,children:U(aa,{label:`The whole recording; drag to choose what the lanes show.`,watch:()=>{e.activities.value,e.labelColors.value,e.range.value,e.duration.value},draw:(t,n,r)=>_o(t,n,r,e),onPointerDown:e=>{e.currentTarget.setPointerCapture(e.pointerId),t(e)},onPointerMove:t})})}var Ko=5,qo=12,Jo=6,Yo=class{store;lanes;gesture=null;touches=new Map;constructor(e,t=()=>[]){this.store=e,this.lanes=t}down(e){if(e.button!==0)return;let t=Xo(e);e.currentTarget.setPointerCapture(e.pointerId),this.touches.set(e.pointerId,t),this.touches.size>1?(this.store.drag.value=null,this.gesture={what:`pinch`}):t.y<22?(this.gesture={what:`scrub`},this.store.seek(this.getSecondsAt(t))):this.gesture={what:`press`,spot:t,border:this.findBorder(t)}}move(e){let t=Xo(e),n=pa(this.touches,e.pointerId,t);n&&this.applyPinch(n,t);let r=this.gesture;if(r?.what===`press`&&Math.abs(t.x-r.spot.x)>4){let{border:e}=r,{x:t}=r.spot;this.gesture=e?{what:`border`,x:t,...e}:{what:`pan`,last:t}}let{gesture:i}=this;if(i?.what===`scrub`)this.store.seek(this.getSecondsAt(t));else if(i?.what===`pan`)this.store.panBy(this.getSecondsPerPixel(t)*(i.last-t.x)),i.last=t.x;else if(i?.what===`border`){let e=this.getSecondsPerPixel(t)*this.store.fps.value,n=Math.max(Math.ceil(e*Jo),1),{frame:r}=i.drag,[a,o]=po(i.lane.segments,r,n),s=Math.round(r+e*(t.x-i.x));i.drag={...i.drag,to:Math.min(Math.max(s,a),o)},this.store.drag.value=i.drag,this.store.seek(i.drag.to/this.store.fps.value)}else i||this.updateHover(e,t)}up(e){let{gesture:t}=this;if(this.touches.delete(e.pointerId),t?.what===`pinch`&&this.touches.size||(this.gesture=null,t?.what===`press`&&this.handleClick(t.spot),t?.what!==`border`))return;let{frame:n,to:r}=t.drag,{level:i}=t.lane;i&&r!==n?this.store.edit.value?.({kind:`move_border`,level:i,frame:n,to:r}):this.store.drag.value=null}cancelDrag(){let{gesture:e}=this;return e?.what===`border`&&(this.cancel(),this.store.seek(e.drag.frame/this.store.fps.value),!0)}cancel(){this.touches.clear(),this.gesture=null,this.store.drag.value=null}leave(){this.store.hovered.value=null}wheel(e){let t=Xo(e),n=e.shiftKey?e.deltaY:e.deltaX;e.shiftKey||Math.abs(e.deltaX)>Math.abs(e.deltaY)?this.store.panBy(n*this.getSecondsPerPixel(t)):this.store.zoomBy(da(e),this.getSecondsAt(t))}applyPinch(e,t){let n=this.getSecondsAt({...t,...e.from});this.store.zoomBy(e.factor,n),this.store.panBy(n-this.getSecondsAt({...t,...e.to}))}handleClick(e){let t=this.findSegment(e),{person:n=null,level:r=null}=co(this.lanes(),e.y)??{};n!==null&&this.store.show(n),t&&(r||n!==null)?this.store.select(t):(n===null||e.x>=78)&&this.store.seek(t?.start_s??this.getSecondsAt(e))}updateHover(e,t){let n=this.findSegment(t),r=(co(this.lanes(),t.y)?.person??null)===null;this.store.hovered.value=n&&r&&n.cluster>=0?n.cluster:null;let i=t.y<22||this.findBorder(t)?`ew-resize`:n?`pointer`:``;e.currentTarget.style.cursor=i}findSegment(e){let t=co(this.lanes(),e.y);if(!t||e.x<78)return;let n=this.getSecondsAt(e),r=t.segments[qt(t.segments,this.store.getFrameAt(n))];return r&&n<r.stop_s&&n>=r.start_s?r:void 0}findBorder(e){let t=co(this.lanes(),e.y);if(!this.store.edit.value||!t?.level||e.x<78)return null;let n=e.reach*this.getSecondsPerPixel(e),r=fo(t.segments,this.getSecondsAt(e),n,this.store.fps.value);return r===null?null:{lane:t,drag:{lane:t.id,frame:r,to:r}}}getSecondsAt({x:e,width:t}){return on(this.store.range.value,t-78,e-78)}getSecondsPerPixel({width:e}){let{start_s:t,stop_s:n}=this.store.range.value;return(n-t)/(e-78)}};function Xo(e){let{width:t}=e.currentTarget.getBoundingClientRect(),n=`pointerType`in e&&e.pointerType===`touch`?qo:Ko;return{...ua(e),width:t,reach:n}}var Zo=`kineme.curves`,Qo=8,$o=[`left_ankle`,`right_ankle`,`left_wrist`,`right_wrist`],es=z(os());function ts({ruler:e=!1}){let t=Pn(),n=ss(),r=Oe(()=>new Yo(t),[t]),i=yt(()=>{let e=t.recording.value?.motion;return e?ns(e):[]}),a=yt(()=>n.value?rs(n.value.list,i.value):[]),[o,s]=[n.value,a.value];if(!o)return U(`div`,{class:`channels`,"aria-busy":`true`});let c=s.map(({head:e})=>`${e.name} ${e.group}`).join(`, `);return U(`div`,{class:`channels`,children:[s.length>0?U(S,{children:[U(aa,{label:`Curves over time: ${c}. Click to go there; use the wheel to zoom, drag to pan.`,watch:()=>{a.value,o.loadCount.value,t.range.value,n.value,t.primitives.value,t.activities.value,t.labelColors.value},draw:(r,i,o)=>{let s=n.value;s&&Mo(r,a.value,s,t,{width:i,height:o,ruler:e})},gestures:r},e?`ruled`:`plain`),U(Uo,{})]}):U(`p`,{class:`empty quiet`,children:`Choose what to draw: “Curves…”.`}),U(cs,{rows:s,tiles:o,ruler:e}),U(us,{list:o.list,defaultJoints:i.value})]})}function ns({joints:e,effectors:t}){return $o.flatMap(n=>e[t[n]??-1]??[])}function rs(e,t){let n=e.curves.map((e,t)=>({curve:t,head:e})),r=new Map(n.map(e=>[as(e.head),e])),i=es.value.flatMap(e=>r.get(e)??[]);if(i.length)return i;let a=n.filter(({head:e})=>e.group===`channels`);return a.length?a.slice(0,Qo):t.flatMap(e=>r.get(as({name:e,group:`height`}))??[])}function is(e,t,n){let r=rs(e,t).map(({head:e})=>as(e)),i=as(n),a=new Set(e.curves.map(as)),o=es.value.filter(e=>!a.has(e)),s=r.includes(i)?r.filter(e=>e!==i):[...r,i];es.value=[...o,...s],localStorage.setItem(Zo,JSON.stringify(es.value))}function as({name:e,group:t}){return`${t}: ${e}`}function os(){let e=Nt(Zo);return Array.isArray(e)?e.filter(e=>typeof e==`string`):[]}function ss(){let e=Pn(),t=e.active.value?.data,n=V(null);return I(()=>{let e=!0;return t?.loadCurves().then(r=>{e&&r&&(n.value=new No(t,r))},()=>void 0),()=>void(e=!1)},[t,n]),yt(()=>n.value?.data===e.active.value?.data?n.value:null)}function cs(e){let t=Pn(),{rows:n,tiles:r,ruler:i}=e,a=la(t.frame,t.playing);return r.loadCount.value,U(`div`,{class:i?`channel-values ruled`:`channel-values`,"aria-hidden":`true`,children:n.map(({curve:e,head:t})=>{let n=r.getValue(e,a.value);return U(`span`,{class:`number`,children:[n===null||Number.isNaN(n)?`–`:ls(n),` `,U(`span`,{class:`quiet`,children:t.unit})]},e)})})}function ls(e){let t=Math.abs(e);return t>=1e5||t>0&&t<.001?e.toExponential(1):e.toFixed(t>=100?0:t>=10?1:2)}function us(e){let{list:t,defaultJoints:n}=e,r=V(``),i=new Set(rs(t,n).map(({head:e})=>e)),a=r.value.toLowerCase().split(/\s+/),o=t.curves.filter(e=>a.every(t=>as(e).toLowerCase().includes(t))),s=[...new Set(o.map(({group:e})=>e))];return U(`details`,{class:`channel-choice`,children:[U(`summary`,{children:`Curves…`}),U(`div`,{class:`channel-list`,children:[U(Ta,{type:`search`,placeholder:`Search: height foot`,"aria-label":`Search the curves`,value:r}),s.map(e=>U(`fieldset`,{children:[U(`legend`,{class:`quiet`,children:e}),o.filter(t=>t.group===e).map(e=>U(Da,{checked:i.has(e),onCheck:()=>is(t,n,e),children:e.name},e.name))]},e)),!o.length&&U(`p`,{class:`quiet`,children:`No curve has that name.`})]})]})}var ds=16,fs=8,ps=[5,4];function ms(e,t,n,r){let{curves:i,opposite:a,leftOut:o,selected:s}=t,{cycles:c,mean:l,beside:u}=i,[d,f]=gs(i,a),p=l.length-1,m=e=>34+e/p*(n-34-8),h=e=>fs+(f-e)/(f-d)*(r-fs-ds);_s(e,{low:d,high:f,x:m,y:h,height:r,last:p});let g=xn(t.color,$i.value);e.lineJoin=`round`,u&&(e.fillStyle=W(`quiet`),e.globalAlpha=.2,bs(e,u,m,h)),e.fillStyle=g,e.globalAlpha=.25,bs(e,i,m,h);let _=Math.max(.18,Math.min(.6,6/c.length));e.lineWidth=1;for(let[t,{values:n,counts:r}]of c.entries())e.strokeStyle=o.has(t)?W(`quiet`):g,e.globalAlpha=r&&!o.has(t)?_:_/2,ys(e,n,m,h);e.strokeStyle=g,e.globalAlpha=1,e.lineWidth=2.5,ys(e,l,m,h);let v=u??a;v&&(e.strokeStyle=u?W(`quiet`):g,e.lineWidth=u?2:1.5,e.setLineDash(ps),ys(e,v.mean,m,h),e.setLineDash([])),e.fillStyle=g;for(let[t,n]of(u?.differs??[]).entries())n&&e.fillRect(m(t-.5),r-ds-3,m(1)-m(0)+.5,3);e.strokeStyle=W(`text`),e.lineWidth=1.5,c[s]&&ys(e,c[s].values,m,h)}function hs(e,t,n,r,i,a){let[o,s]=gs(e,t),c=Math.min(Math.max((n-34)/(i-34-8),0),1),l=Math.round(c*(e.mean.length-1)),u=s-(r-fs)/(a-fs-ds)*(s-o),d=e.cycles.map(({values:e})=>Math.abs((e[l]??1/0)-u));return d.indexOf(Math.min(...d))}function gs(e,t){let[n,r]=[1/0,-1/0],i=[t?.mean??[],e.beside?.mean??[]];for(let t of[...e.cycles.map(e=>e.values),...i])for(let e of t)e!==null&&(e<n&&(n=e),e>r&&(r=e));if(!(r>n))return[Number.isFinite(n)?n-.5:0,Number.isFinite(n)?n+.5:1];let a=.06*(r-n);return[n-a,r+a]}function _s(e,{low:t,high:n,x:r,y:i,height:a,last:o}){e.font=`10px system-ui, sans-serif`,e.textBaseline=`middle`,e.textAlign=`right`,e.fillStyle=W(`quiet`),e.strokeStyle=W(`line`),e.lineWidth=1;let s=vs(n-t),c=Math.max(0,-Math.floor(Math.log10(s)+1e-9));for(let a=Math.ceil(t/s);a*s<=n;a++){let t=Math.round(i(a*s))+.5;ya(e,[[34,t],[r(o),t]]),e.fillText((a*s).toFixed(Math.min(c,4)),29,t)}for(let[t,n]of[[0,`left`],[.5,`center`],[1,`right`]])e.textAlign=n,e.fillText(`${100*t} %`,r(t*o),a-ds/2+1);e.textAlign=`left`}function vs(e){let t=10**Math.floor(Math.log10(e/5));return[1,2,5,10].map(e=>e*t).find(t=>e/t<=5)}function ys(e,t,n,r){ya(e,t.map((e,t)=>e===null?null:[n(t),r(e)]))}function bs(e,{mean:t,sd:n},r,i){if(!(t.includes(null)||n.includes(null))){e.beginPath();for(let a=0;a<t.length;a++)e.lineTo(r(a),i(t[a]+n[a]));for(let a=t.length-1;a>=0;a--)e.lineTo(r(a),i(t[a]-n[a]));e.fill()}}function xs(){let e=Pn(),t=V(``),n=V(``),r=yt(()=>e.opened.value.filter(t=>t!==e.active.value)),i=yt(()=>r.value.find(({recording:e})=>e.value.id===n.value)),a=Ls(t,i),o=yt(()=>a.value?.curves?.cycles??[]),s=yt(()=>Ms(e,o.value)),c=yt(()=>js(e,o.value)),l=a.value;if(!e.clusters.value.length)return U(`p`,{class:`empty quiet`,children:`No cluster to show.`});if(!l?.curves)return U(`p`,{class:`empty quiet`,"aria-busy":!l,children:l?`No curves of this cluster.`:`Measuring …`});let{channels:u,curves:d,opposite:f}=l,p=_n(Rs(e)),m=d.cycles.filter(({counts:e},t)=>e&&!c.value.has(t)),h=Ps(m);return U(`div`,{class:`curves`,children:[U(`div`,{class:`curve-choice`,children:[U(wa,{color:p}),U(Cs,{channels:u,channel:d.channel,onChoose:e=>t.value=e}),U(`span`,{class:`quiet`,children:d.unit})]}),r.value.length>0&&U(`div`,{class:`curve-choice`,children:[U(`span`,{class:`quiet`,children:`Beside`}),U(Ea,{label:`Beside`,value:i.value?n.value:``,options:[[``,`no other recording`],...r.value.map(({recording:e})=>[e.value.id,e.value.name])],onSelect:e=>n.value=e})]}),U(`div`,{class:`curve-room`,children:[U(aa,{label:`Curves of ${Dt(d.total,`repetition`)}, with mean and deviation. Click one to go to it.`,watch:()=>void[a.value,s.value,c.value,e.cluster.value],draw:(t,...n)=>{let{curves:r,opposite:i}=a.value??{},o=_n(Rs(e)),l={leftOut:c.value,selected:s.value,color:o};r&&ms(t,{curves:r,opposite:i??null,...l},...n)},onClick:t=>{let{left:n,top:r,width:i,height:a}=t.currentTarget.getBoundingClientRect(),[o,s]=[t.clientX-n,t.clientY-r],c=hs(d,f,o,s,i,a);As(e,d.cycles[c])}}),U(ws,{cycles:d.cycles})]}),U(Ds,{cycle:d.cycles[s.value],unit:d.unit,isOut:c.value.has(s.value)}),U(Os,{title:`Farthest`,label:`Farthest from the mean`,cycles:d.n<3?[]:m.slice(0,Es),unit:d.unit}),U(Os,{title:`Left out`,label:`Left out by hand`,cycles:d.cycles.filter((e,t)=>c.value.has(t)),isOut:!0}),U(`p`,{class:`quiet note`,children:[Ss(d),h&&`; range ${Is(h,d.unit)}`,i.value&&Ts(e,i.value,d),f&&`; ${f.channel} (dashed)`,d.turned>0&&`; ${Dt(d.turned,`activity`,`activities`)} turned to the phase of the others`]})]})}function Ss({n:e,total:t,ends:n,left_out:r,cycles:i}){let a=Dt(t,`repetition`),o=i.length<t?`, ${i.length} drawn`:``,s=r?`, ${r} left out by hand`:``;return!e&&r?`${a}${o}${s}, no other recorded as a whole`:e?e===1?`1${n?``:` inner`} of ${a}${o}${s}, bold: too few for a mean`:`${e}${n?``:` inner`} of ${a}${o}${s}, mean ± standard deviation`:`${a}${o}, none recorded as a whole`}function Cs(e){let{channels:t,channel:n,onChoose:r}=e,i=t.find(({name:e})=>e===n)?.group??``,a=[...new Set(t.map(e=>e.group))],o=e=>t.filter(t=>t.group===e).map(({name:e})=>e);return U(S,{children:[U(Ea,{label:`Channel`,value:n,options:o(i).map(e=>[e,e]),onSelect:r}),U(Ea,{label:`What is measured`,value:i,options:a.map(e=>[e,e]),onSelect:e=>r(o(e)[0])})]})}function ws({cycles:e}){let t=Pn().playhead.value,n=e.find(e=>e.start_s<=t&&t<e.stop_s);return U(`div`,{class:`curve-now`,style:{left:`34px`,right:`8px`},children:n&&U(sa,{share:(t-n.start_s)/(n.stop_s-n.start_s)})})}function Ts(e,t,{beside:n,channel:r}){let{name:i}=t.recording.value;if(n)return`; ${i} (dashed): ${n.n} of ${n.total}; a bar where they differ (95 %)`;let{label:a}=e.shownCluster.value??e.clusters.value[0]??{};return a?`; ${i} has no “${a}”, or no ${r}`:`; name this movement alike in both to see that of ${i}`}var Es=3;function Ds(e){let{cycle:t,unit:n,isOut:r}=e,i=Pn();if(!t)return U(`p`,{class:`chosen quiet`,children:`None of them at the playhead.`});let a=Ns(t),o=i.selected.value?.start_frame===t.start_frame?` (X)`:``,s=i.edit.value;return U(`p`,{class:`chosen`,"aria-label":`At the playhead`,children:[U(`span`,{class:`number`,children:[t.start_s.toFixed(2),` s`]}),a!==null&&U(`span`,{class:`quiet`,children:[`range `,Is(Fs(a),n)]}),U(`span`,{class:`quiet`,children:r?`left out by hand`:ks(t,n)}),U(`span`,{class:`spacer`}),s&&U(G,{title:(r?`Count it in the mean again`:`Leave it out of the mean`)+o,onClick:()=>s({kind:`exclude`,frames:[t.start_frame],excluded:!r}),children:r?`Bring back`:`Leave out`})]})}function Os(e){let{title:t,label:n,cycles:r,unit:i=``,isOut:a=!1}=e,o=Pn(),s=o.edit.value,c=a?`Bring back into the mean`:`Leave out of the mean`;return r.length?U(`p`,{class:a?`farthest left-out`:`farthest`,"aria-label":n,children:[U(`span`,{class:`quiet`,children:[t,`:`]}),r.map(e=>{let{start_frame:t,start_s:n,stop_s:r}=e;return U(`span`,{class:`chip`,children:[U(G,{title:`${a?`left out by hand`:ks(e,i)}, from ${n.toFixed(2)} to ${r.toFixed(2)} s`,onClick:()=>As(o,e),children:[n.toFixed(1),` s`]}),s&&U(G,{title:c,"aria-label":`${c}: ${n.toFixed(1)} s`,onClick:({detail:e})=>{e<2&&s({kind:`exclude`,frames:[t],excluded:!a})},children:a?`↺`:`×`})]},t)})]}):null}function ks({distance:e,note:t},n){let r=e?.toPrecision(2),i=r===void 0?``:Is(r,n);return[i&&`${i} from the mean`,t].filter(Boolean).join(`, `)}function As(e,t){let n=e.primitives.value.find(({start_frame:e})=>e===t?.start_frame);n&&t&&(e.select(n),n.start_s<t.start_s&&t.start_s<n.stop_s&&e.seek(t.start_s))}function js(e,t){let n=e.primitives.value.filter(({excluded:e})=>e),r=new Set(n.map(({start_frame:e})=>e));return new Set(t.flatMap(({start_frame:e},t)=>r.has(e)?[t]:[]))}function Ms(e,t){let{level:n,start_frame:r}=e.selected.value??{},i=e.playhead.value,a=t.findIndex(e=>e.start_frame===r);return a>=0&&n===`primitive`?a:t.findIndex(e=>e.start_s<=i&&i<e.stop_s)}function Ns({values:e}){let t=e.filter(e=>e!==null);return t.length?Math.max(...t)-Math.min(...t):null}function Ps(e){let{mean:t,deviation:n}=Ot(e.map(Ns).filter(e=>e!==null));return t===null?``:Fs(t)+(n===null?``:` ± ${Fs(n)}`)}function Fs(e){return`${Number(e.toPrecision(3))}`}function Is(e,t){return t===`°`?`${e}°`:`${e} ${t}`.trim()}function Ls(e,t){let n=Pn(),r=V(null),i=yt(()=>n.recording.value?.revision??0),a=yt(()=>n.active.value?.data),o=yt(()=>Rs(n)),s=yt(()=>t.value?.recording.value.id??``),c=yt(()=>t.value?.recording.value.revision??0);return Et(()=>{let t=!0,[n,l,u,d]=[a.value,o.value,e.value,i.value];if(c.value,n)return zs(n,l,u,d,s.value).then(e=>{t&&(r.value=e)},()=>void 0),()=>void(t=!1)}),yt(()=>r.value?.data===a.value?r.value:null)}function Rs(e){return(e.shownCluster.value??e.clusters.value[0])?.id??-1}async function zs(e,t,n,r,i){if(t<0)return{data:e,channels:[],curves:null,opposite:null};let a=await e.loadCycleChannels(),o=a.some(({name:e})=>e===n)?n:``,s=await e.loadClusterCurves(t,o,r,i),c=!i&&a.find(({name:e})=>e===s?.channel)?.opposite;return{data:e,channels:a,curves:s,opposite:c?await e.loadClusterCurves(t,c,r):null}}function Bs(){return U(`div`,{class:`cluster-panel`,children:[U(`div`,{children:[U(Hs,{}),U(Gs,{})]}),U(`div`,{children:U(xs,{})})]})}var Vs=[[`first seen first`,(e,t)=>e.members[0].start_frame-t.members[0].start_frame],[`most seconds first`,(e,t)=>t.total_s-e.total_s],[`most repetitions first`,(e,t)=>t.members.length-e.members.length],[`by name`,(e,t)=>(e.label||`￿`).localeCompare(t.label||`￿`)||e.id-t.id]];function Hs(){let e=Pn(),t=e.edit.value,n=e.clusters.value,r=e.shownCluster.value;return!t||n.length<2?null:U(`div`,{class:`cluster-tools`,children:[U(Us,{label:`Number the clusters anew`,title:`Number anew…`,options:Vs.map(([e])=>[e,e]),onSelect:r=>{let i=Vs.find(([e])=>e===r)?.[1],a=i&&Ws(e,n.slice().sort(i));a&&t({kind:`order_clusters`,order:a})}}),r&&U(Us,{label:`Merge cluster ${r.id} into another`,title:`Merge ${r.label||r.id} into…`,options:n.filter(({id:e})=>e!==r.id).map(({id:e,label:t})=>[String(e),t||`cluster ${e}`]),onSelect:e=>t({kind:`merge_clusters`,cluster:r.id,into:Number(e)})})]})}function Us(e){let{label:t,title:n,options:r,onSelect:i}=e;return U(`select`,{"aria-label":t,value:``,onChange:({currentTarget:e})=>{let{value:t}=e;e.value=``,i(t)},children:[U(`option`,{value:``,children:n}),r.map(([e,t])=>U(`option`,{value:e,children:t},e))]})}function Ws(e,t){let n=e.recording.value?.segmentation.segments??[],r=[...new Set(n.map(e=>e.cluster))].filter(e=>e>=0);return[...new Set([...t.map(({id:e})=>e),...r.sort((e,t)=>e-t)])]}function Gs(){let e=Pn(),t=e.clusters.value;return t.length===0?U(Ks,{}):U(qs,{first:`Cluster`,rows:t.map(t=>{let{id:n,members:r,mean_s:i,total_s:a}=t;return{id:n,count:r.length,mean_s:i,total_s:a,color:_n(n),head:U(Js,{cluster:t}),class:e.cluster.value===n?`shown`:``,onPointerEnter:()=>void(e.hovered.value=n),onPointerLeave:()=>void(e.hovered.value=null),onClick:()=>e.selectCluster(n)}})})}function Ks(){let e=Pn(),{primitives:t,activities:n}=e,r=t.value.some(e=>e.label)?t:n,i=tn(r.value);if(!i.length)return U(`p`,{class:`empty quiet`,children:`Nothing repeats itself here: there are no clusters.`});let a=t=>{let n=e=>e.label===t,i=r.value.find(t=>n(t)&&t.start_frame>e.frame.value)??r.value.find(n);i&&e.select(i)};return U(qs,{first:`Label`,rows:i.map(({label:t,count:n,total_s:r})=>{let i=e.labelColors.value.get(t)??`#DDDDDD`;return{id:t,color:i,head:U(G,{class:`plain`,title:`Go to the next one`,children:[U(wa,{color:i}),U(`span`,{class:`cluster-name`,children:t})]}),count:n,mean_s:r/n,total_s:r,onClick:()=>a(t)}})})}function qs({first:e,rows:t}){let n=Math.max(...t.map(({count:e})=>e));return U(Va,{class:`clusters number`,columns:[e,`Count`,[`Mean`,`Mean duration of one, seconds`],[`Total`,`All of them together`]],rows:t.map(({id:e,color:t,count:r,mean_s:i,total_s:a,...o})=>({...o,key:e,cells:[U(`span`,{class:`count`,children:[U(`span`,{class:`bar`,style:{width:`${40*r/n}px`,background:t}}),r]}),`${i.toFixed(2)} s`,pn(a,+(a<60))]}))})}function Js({cluster:e}){let t=Pn(),{id:n,label:r}=e,i=V(!1),a=R(null),o=t.edit.value;if(L(()=>{i.value&&a.current?.select()},[i.value]),i.value&&o)return U(Pa,{field:a,value:r,"aria-label":`Name of cluster ${n}`,onName:e=>o({kind:`name_cluster`,cluster:n,label:e}),onDone:()=>i.value=!1});let s=()=>void(i.value=o!==null);return U(G,{class:`plain`,"aria-pressed":t.cluster.value===n,title:o?`Double click or F2 to name it`:void 0,onDblClick:s,onKeyDown:e=>e.key===`F2`&&s(),children:[U(wa,{color:_n(n)}),U(`span`,{class:`cluster-name`,children:r||`cluster ${n}`}),t.present.value?.cluster===n&&U(`span`,{class:`now`,title:`At the playhead`})]})}var Ys=2,Xs=[`ArrowLeft`,`ArrowRight`,`ArrowUp`,`ArrowDown`,`Home`,`End`,`PageUp`,`PageDown`],Zs=[` `,`Enter`],Qs=`textarea, input:is([type=text], [type=number], [type=search])`,$s=[[`Space`,`Play or pause`],[`← →`,`One frame back or on`],[`Shift + ← →`,`The segment before or after`],[`L`,`Loop what is between the marks, else the segment; or stop looping`],[`I, O`,`Mark the start or the end of what to loop; once more takes the mark away`],[`Z`,`Zoom to what is between the marks, else to the segment`],[`, .`,`Look at coarser or finer segments`],[`V`,`Keep the repetition as a ghost, to lay it over others; once more takes it away`],[`G`,`Show curves and signals over time, or hide them`],[`F`,`Full screen, and back`],[`+ −`,`Zoom in or out`],[`Home, End`,`To the start or the end`],[`0`,`Show all of the recording`]],ec=!1,tc=null;function nc(e,t=()=>void 0,n=()=>({})){rc(e),dc(),sc(),Mt(window,{keydown:n=>{if(!cc(n))return;let r=oc(n,e)??t(n);r&&(n.preventDefault(),lc(),r())}}),Object.defineProperty(window,"kineme",{get:()=>Object.freeze({...fc(e),...n()})})}function rc(e){let t=0;ra.add(n=>{if(!e.playing.value)return;let{value:r}=e.playhead,i=e.videoTime.value?.getTime()??null;t=i===`waiting`?t+n:0;let a=i===`waiting`&&t<Ys||typeof i==`number`?0:n*e.speed.value,o=ac(typeof i==`number`?i:r,a,e.loop.value);o>=e.duration.value&&(e.playing.value=!1),e.seek(o),ra.request()}),ct(()=>{e.playing.value&&ra.request()})}function ic(e){let t=e.playhead.value>=e.duration.value-.5/e.fps.value;!e.playing.value&&t&&!e.loop.value&&e.seek(0),e.playing.value=!e.playing.value}function ac(e,t,n){let r=e+t;return!n||n.stop_s<=n.start_s?r:r<n.start_s?n.start_s:r<n.stop_s?r:n.start_s+(r-n.start_s)%(n.stop_s-n.start_s)}function oc(e,t){if(e.ctrlKey||e.metaKey||e.altKey)return;let n=n=>()=>e.shiftKey?t.stepSegment(n):t.step(n);return{" ":()=>ic(t),ArrowLeft:n(-1),ArrowRight:n(1),l:()=>t.toggleLoop(),L:()=>t.toggleLoop(),i:()=>t.toggleMark(`start_s`),o:()=>t.toggleMark(`stop_s`),z:()=>t.zoomToTarget(),"+":()=>t.zoomBy(.7),"=":()=>t.zoomBy(.7),"-":()=>t.zoomBy(1/.7),v:()=>t.toggleGhost(),g:()=>void(t.curves.value=!t.curves.value),f:Pt,",":()=>t.stepDetail(-1),".":()=>t.stepDetail(1),0:()=>void(t.zoom.value=null),Home:()=>t.seek(0),End:()=>t.seek(t.duration.value)}[e.key]}function sc(){Mt(window,{pointerdown:()=>void(ec=!0),keydown:e=>{e.key===`Tab`&&(ec=!1)},focusin:e=>{tc=ec&&e.target instanceof Element?e.target:null},wheel:e=>{let t=e.target;t instanceof HTMLInputElement&&t.type===`number`&&t.blur()}},{capture:!0,passive:!0})}function cc(e){let t=e.target instanceof HTMLElement?e.target:null;return e.defaultPrevented||t?.closest(`dialog[open]`)?!1:!t||t===document.body?!0:t.matches(Qs)?!1:e.altKey||e.ctrlKey||e.metaKey?!0:t===tc||!uc(t).includes(e.key)}function lc(){tc instanceof HTMLElement&&tc===document.activeElement&&tc.blur()}function uc(e){return e.matches(`[type=range]`)?Xs:e.closest(`select, [role=tab], [role=separator]`)?[...Xs,...Zs]:e.closest(`button, input, summary, a, label`)?Zs:[]}function dc(){let e=[];addEventListener(`beforeprint`,()=>{Qi.value=!0,ra.drawNow();for(let t of document.querySelectorAll(`.viewer canvas`)){let n=new Image;n.className=`on-paper`,n.src=t.toDataURL(),t.after(n),e.push(n)}}),addEventListener(`afterprint`,()=>{Qi.value=!1;for(let t of e.splice(0))t.remove()})}function fc(e){let t=e.recording.value;return{name:t?.name??``,playhead:e.playhead.value,frame:e.frame.value,duration:e.duration.value,playing:e.playing.value,speed:e.speed.value,loop:e.loop.value,selection:e.selection.value,cluster:e.cluster.value,inStep:e.inStep.value,range:e.range.value,revision:t?.revision??0,saved:t?.saved??``,n_segments:e.table.value?.segments.length??0,finding:t?.finding??!1,hasMotion:!!e.active.value?.motion.value,other:e.others.value[0]?.name??null,others:e.others.value.map(({name:e})=>e),rate:ra.measureRate(),drawn:ra.drawn}}function pc(e){let t=[`layout`];return e.left&&t.push(`with-left`),e.viewer||t.push(`without-viewer`),e.curves&&t.push(`with-curves`),U(`div`,{class:t.join(` `),style:gc(),children:[U(`header`,{class:`place-header`,children:e.header}),e.left&&U(`aside`,{class:`place-left`,"aria-label":`Recordings and segmentation`,children:[e.left,U(vc,{name:`left`,title:`recordings and segmentation`,minimum:150,at:`right`})]}),e.viewer&&U(`main`,{class:`place-viewer`,children:e.viewer}),U(`section`,{class:`place-matrix`,"aria-label":`Self-similarity`,children:[e.matrix,e.viewer&&U(vc,{name:`matrix`,title:`matrix`,minimum:160,at:`left`})]}),U(`aside`,{class:`place-side`,"aria-label":`Side panel`,children:[e.side,U(vc,{name:`side`,title:`side panel`,minimum:220,at:`left`})]}),U(`div`,{class:`place-transport`,children:e.transport}),U(`section`,{class:`place-timeline`,"aria-label":`Timeline`,children:[e.timeline,U(vc,{name:`timeline`,title:`timeline`,minimum:110,at:`top`})]}),e.curves&&U(`section`,{class:`place-curves`,"aria-label":`Curves`,children:[e.curves,U(vc,{name:`curves`,title:`curves`,minimum:70,at:`top`})]})]})}var mc=`kineme.sizes`,hc=z(Nt(mc)??{});function gc(){let e=Object.entries(hc.value).filter(([,e])=>e!==null);return Object.fromEntries(e.map(([e,t])=>[`--${e}`,`${t}px`]))}var _c=16;function vc(e){let{name:t,title:n,minimum:r,at:i}=e,a=i!==`top`,o=i===`right`?1:-1,s=e=>a?e.parentElement.clientWidth:e.parentElement.clientHeight,c=e=>a?e.clientX:e.clientY,l=e=>{let n=.6*(a?innerWidth:innerHeight),i=e===null?null:Math.round(Math.min(Math.max(e,r),n));hc.value={...hc.value,[t]:i},localStorage.setItem(mc,JSON.stringify(hc.value))};return U(`div`,{class:`splitter ${i}`,role:`separator`,tabIndex:0,"aria-orientation":a?`vertical`:`horizontal`,"aria-label":`Size of ${n}`,"aria-valuenow":hc.value[t]??0,"aria-valuemin":r,title:`Drag, or arrow keys; a double click gives the usual size back`,onPointerDown:e=>{let t=e.currentTarget,n=c(e),r=s(t);e.preventDefault(),t.setPointerCapture(e.pointerId),t.onpointermove=e=>l(r+o*(c(e)-n)),t.onpointerup=t.onpointercancel=()=>t.onpointermove=null},onKeyDown:e=>{let t=(a?[`ArrowLeft`,`ArrowRight`]:[`ArrowUp`,`ArrowDown`]).indexOf(e.key);t<0||cc(e)||(e.preventDefault(),e.stopPropagation(),l(s(e.currentTarget)+o*(t===0?-16:_c)))},onDblClick:()=>l(null)})}function yc({label:e,tabs:t,open:n}){let r=V(t[0]?.id??``),i=n??r,a=t.find(e=>e.id===i.value)??t[0];return U(`div`,{class:`tabs`,children:[U(`div`,{class:`tab-row`,role:`tablist`,"aria-label":e,onKeyDown:e=>{let n={ArrowRight:1,ArrowLeft:-1}[e.key];if(!n||!a||cc(e))return;e.preventDefault(),e.stopPropagation();let r=t[(t.indexOf(a)+n+t.length)%t.length];i.value=r.id,document.getElementById(`tab-${r.id}`)?.focus()},children:t.map(e=>U(G,{id:`tab-${e.id}`,role:`tab`,"aria-selected":e===a,"aria-controls":`panel-${e.id}`,tabIndex:e===a?0:-1,onClick:t=>{i.value=e.id,bc(t.currentTarget)},children:e.title},e.id))}),a&&U(`div`,{class:`tab-panel`,id:`panel-${a.id}`,role:`tabpanel`,"aria-labelledby":`tab-${a.id}`,tabIndex:0,children:a.panel()})]})}function bc(e){document.documentElement.scrollHeight>innerHeight&&e.closest(`.tabs`)?.scrollIntoView({block:`start`})}var xc=3;function Sc(e,t,n,r,i){let{side:a,down:o,across:s}=r,c=(s.stop_s-s.start_s)/(a*devicePixelRatio),l=Ac(t,c);va(e,[9,9,a,a],()=>{e.translate(9,9),e.fillStyle=W(`matrix-low`),e.fillRect(0,0,a,a),e.imageSmoothingEnabled=kc(t,l)/c<xc*devicePixelRatio,n.clearQueue();for(let i of jc(t,l,o,s))Cc(e,t,n,i,r);Tc(e,r,i),Ec(e,r,i)}),Oc(e,r,i)}function Cc(e,t,n,r,i){for(let a=r;a.level<t.sizes.length;a=Mc(a)){let o=Nc(a),s=n.get(o.place);if(!s)continue;let c=kc(t,a.level),{start_s:l,stop_s:u}=i.across,d=i.side/(u-l)*c,f=an(i.across,i.side,a.column*t.tile*c),p=an(i.down,i.side,a.row*t.tile*c);va(e,wc(t,r,i),()=>{e.translate(f,p),o.mirrored&&e.transform(0,1,1,0,0,0),e.drawImage(s,0,0,s.width*d,s.height*d)});return}}function wc(e,t,{side:n,down:r,across:i}){let a=kc(e,t.level)*e.tile,o=(e,t)=>Math.round(an(e,n,t*a)),[s,c]=[o(i,t.column),o(r,t.row)];return[s,c,o(i,t.column+1)-s,o(r,t.row+1)-c]}function Tc(e,t,n){let r=n.hovered.value;for(let[i,a]of[[n.primitives.value,1],[n.activities.value,1.75]]){let[o,s]=lo(i,t.across.start_s,t.across.stop_s);for(let c of i.slice(o,s)){let i=n.getColor(c);if(!i)continue;let o=Dc(c,c,t);if(o[2]<3)continue;let s=r!==null&&c.cluster===r?a+1.5:a;e.strokeStyle=W(`page`),e.lineWidth=s+1.5,e.strokeRect(...o),e.strokeStyle=i,e.lineWidth=s,e.strokeRect(...o)}}}function Ec(e,t,n){let r=n.selected.value;if(!r)return;let{side:i}=t,[a,o,s,c]=Dc(r,r,t);e.fillStyle=W(`accent`),e.globalAlpha=.22,e.fillRect(a,0,s,i),e.fillRect(0,o,i,c),e.globalAlpha=1,e.strokeStyle=W(`accent`),e.lineWidth=1;let l=r.level===`activity`?n.activities.value:n.primitives.value;for(let n of l)if(!(n.cluster!==r.cluster||n.cluster<0))for(let i of[Dc(r,n,t),Dc(n,r,t)])i[2]>=2&&i[3]>=2&&e.strokeRect(...i)}function Dc(e,t,{side:n,down:r,across:i}){let a=an(i,n,t.start_s),o=an(r,n,e.start_s);return[a,o,an(i,n,t.stop_s)-a,an(r,n,e.stop_s)-o]}function Oc(e,{side:t,down:n,across:r},i){for(let a of i.activities.value){let{start_s:o,stop_s:s}=a,c=i.getColor(a);if(!c)continue;e.fillStyle=c;let l=(e,n)=>9+Math.min(Math.max(an(e,t,n),0),t),[u,d]=[l(r,o),l(n,o)];e.fillRect(u,1,l(r,s)-u,6),e.fillRect(1,d,6,l(n,s)-d)}}function kc(e,t){return 2**t/e.fps}function Ac(e,t){let n=Math.round(Math.log2(Math.max(t*e.fps,1e-9)));return Math.min(Math.max(n,0),e.sizes.length-1)}function jc(e,t,n,r){let i=kc(e,t)*e.tile,a=Math.max(Math.ceil((e.sizes[t]??0)/e.tile)-1,0),o=({start_s:e,stop_s:t})=>{let n=Math.max(Math.floor(e/i),0),r=Math.min(Math.max(Math.ceil(t/i)-1,n),a);return Array.from({length:r-n+1},(e,t)=>n+t)};return o(n).flatMap(e=>o(r).map(n=>({level:t,row:e,column:n})))}function Mc({level:e,row:t,column:n}){return{level:e+1,row:t>>1,column:n>>1}}function Nc(e){let{level:t,row:n,column:r}=e;return n>=r?{place:e,mirrored:!1}:{place:{level:t,row:r,column:n},mirrored:!0}}function Pc(e,t){if(!e)return t;let n=e.stop_s-e.start_s-(t.stop_s-t.start_s);return Math.abs(n)<1e-6*(t.stop_s-t.start_s)?e:t}var Fc=240,Ic=6,Lc=class{data;loadCount=z(0);cache=new jt(Fc);queue=new Map;loading=0;shades=Bc();theme=null;constructor(e){this.data=e}get(e){let t=`${e.level}/${e.row}/${e.column}`,n=this.cache.get(t);if(n!==void 0)return n&&n.picture;this.queue.has(t)||(this.queue.set(t,e),this.load())}clearQueue(){this.queue.clear()}applyTheme(e){if(e!==this.theme){this.theme=e,this.shades=Bc();for(let e of this.cache.values())e&&zc(e,this.shades)}}async load(){if(this.loading>=Ic)return;let e=this.queue.entries().next().value;if(!e)return;let[t,{level:n,row:r,column:i}]=e;this.queue.delete(t),this.loading+=1;try{let e=await this.data.loadTile(n,r,i),a=e&&await Rc(e);a&&zc(a,this.shades),this.cache.set(t,a)}catch{this.cache.set(t,null)}finally{--this.loading}this.loadCount.value+=1,this.load()}};async function Rc(e){let t=await createImageBitmap(e),n=new OffscreenCanvas(t.width,t.height),r=n.getContext(`2d`,{willReadFrequently:!0});r.drawImage(t,0,0),t.close();let{data:i}=r.getImageData(0,0,n.width,n.height),a=new Uint8Array(i.length/4);for(let e=0;e<a.length;e++)a[e]=i[4*e];return{grey:a,picture:n}}function zc({grey:e,picture:t},n){let r=new ImageData(t.width,t.height),i=new Uint32Array(r.data.buffer);e.forEach((e,t)=>i[t]=n[e]),t.getContext(`2d`).putImageData(r,0,0)}function Bc(){let e=Cn(W(`matrix-low`)),t=Cn(W(`matrix-high`)),n=new Uint8ClampedArray(1024).fill(255);for(let r=0;r<256;r++)e.forEach((e,i)=>n[4*r+i]=e+r/255*(t[i]-e));return new Uint32Array(n.buffer)}function Vc(){let e=Pn(),t=e.active.value?.data,n=Oe(()=>t?new Lc(t):null,[t]),r=Oe(()=>new Gc(e),[e]),{pointer:i,rows:a}=r;return n?U(`div`,{class:`matrix`,children:[U(`div`,{class:`matrix-square`,children:[U(aa,{label:`Self-similarity: how similar any two frames are. Click to go there; use the wheel or two fingers to zoom, drag to pan.`,watch:()=>{e.activities.value,e.primitives.value,e.selected.value,e.labelColors.value,e.range.value,e.hovered.value,a.value,n.loadCount.value},draw:(r,i)=>{let{active:o}=e;n.applyTheme($i.value);let s=o.value?.data===t?e.recording.value?.matrix:void 0,c={side:i-9,down:a.value,across:e.range.value};s&&s.sizes.length&&Sc(r,s,n,c,e)},gestures:r}),U(Hc,{rows:a})]}),U(`p`,{class:`matrix-note quiet number`,children:i.value?`${pn(Math.max(i.value.x,0),1)} and ${pn(Math.max(i.value.y,0),1)}`:`How similar any two frames are`})]}):U(`div`,{class:`matrix`})}function Hc({rows:e}){let{playhead:t,range:n}=Pn();return U(`div`,{class:`cross`,children:[U(sa,{share:an(n.value,1,t.value)}),U(sa,{share:an(e.value,1,t.value),horizontal:!0})]})}function Uc(){return U(`div`,{class:`matrix-place`,children:[U(`div`,{class:`matrix-top`,children:U(Vc,{})}),U(Wc,{})]})}function Wc(){let e=Pn(),t=e.present.value;if(!t)return null;let n=e.recording.value?.segmentation,r=n&&new Er(n,t),i=e.clusters.value.find(e=>e.id===t.cluster)?.members??[],a=i.indexOf(t),o=t=>{let n=i[(a+t+i.length)%i.length];n&&e.select(n)};return U(`section`,{class:`present`,"aria-label":`At the playhead`,children:[U(`p`,{class:`present-name`,children:[U(wa,{color:e.getColor(t)}),U(`b`,{children:$t(t)}),U(`span`,{class:`spacer`}),a>=0&&U(S,{children:[U(`span`,{class:`quiet number`,children:[a+1,` of `,i.length]}),U(La,{icon:`back`,label:`Member before`,onClick:()=>o(-1)}),U(La,{icon:`on`,label:`Next member`,onClick:()=>o(1)})]})]}),U(`p`,{class:`quiet number`,children:[pn(t.start_s,2),` to `,pn(t.stop_s,2),` ·`,` `,Zt(t).toFixed(2),` s`,r?.text&&U(`span`,{title:r.why,children:[` · `,r.text]})]})]})}var Gc=class{store;pointer=z(null);rows;movedRows=z(null);touches=new Map;pressed=null;constructor(e){this.store=e,this.rows=B(()=>Pc(this.movedRows.value,e.range.value))}down(e){let t=ua(e);e.currentTarget.setPointerCapture(e.pointerId),this.touches.set(e.pointerId,t),this.pressed=this.touches.size>1?null:{place:t,last:t,far:!1}}move(e){let t=ua(e),n=Kc(e);this.pointer.value=this.getTimesAt(t,n);let r=pa(this.touches,e.pointerId,t);r&&(this.zoom(r.factor,this.getTimesAt(r.from,n)),this.pan(r.from,r.to,n));let{pressed:i}=this;if(!i)return;let a=i.place;i.far||=Math.hypot(t.x-a.x,t.y-a.y)>=4,i.far&&(this.pan(i.last,t,n),i.last=t)}up(e){let t=this.pressed&&!this.pressed.far;if(this.pressed=null,this.touches.delete(e.pointerId),!t)return;let{x:n}=this.getTimesAt(ua(e),Kc(e)),r=Wt(this.store.primitives.value,this.store.getFrameAt(n));r&&this.store.select(r,{seek:!1}),this.store.seek(n)}cancel(){this.pressed=null,this.touches.clear()}leave(){this.pointer.value=null}wheel(e){this.zoom(da(e),this.getTimesAt(ua(e),Kc(e)))}zoom(e,t){let n=sn(this.rows.value,e,t.y,this.store.duration.value);this.store.zoomBy(e,t.x),this.movedRows.value=this.store.zoom.value?n:null}pan(e,t,n){if(!this.store.zoom.value)return;let[r,i]=[this.getTimesAt(e,n),this.getTimesAt(t,n)];this.movedRows.value=cn(this.rows.value,r.y-i.y,this.store.duration.value),this.store.panBy(r.x-i.x)}getTimesAt({x:e,y:t},n){return{x:on(this.store.range.value,n,e-9),y:on(this.rows.value,n,t-9)}}};function Kc(e){return e.currentTarget.clientWidth-9}var qc=500,Jc=[`Activity`,`Start`,`Length`,`Times`,[`Mean ± sd`,`Mean and standard deviation`],`Each, in seconds`];function Yc(e){let t=Pn(),n=e.recording.value?.segmentation,r=n?nn(n):[];if(!r.length)return U(`p`,{class:`empty quiet`,children:`Nothing repeats itself here.`});let i=r.reduce((e,{leftOut:t})=>e+t.filter(Boolean).length,0);return U(Va,{class:`repetitions number`,caption:i>0&&U(`span`,{class:`quiet`,children:[Dt(i,`repetition`),` left out of means by hand.`]}),columns:Jc,rows:r.map(({activity:e,durations:n,leftOut:r,mean:i,deviation:a})=>({key:e.start_frame,head:U(G,{class:`plain`,onClick:()=>t.select(e),children:[U(wa,{color:t.getColor(e)}),$t(e)]}),cells:[pn(e.start_s,1),`${Zt(e).toFixed(1)} s`,Xc(r),`${i?.toFixed(2)??``}${a===null?``:` ± ${a.toFixed(2)}`}`,n.map((e,t)=>[t>0&&`  `,r[t]?U(`s`,{title:`left out by hand`,children:e.toFixed(2)}):e.toFixed(2)])]}))})}function Xc(e){let t=e.filter(e=>!e).length;return t<e.length?`${t} of ${e.length}`:`${t}`}function Zc(){let e=Qc(Pn().recording),t=e.value;if(!t)return null;let{provenance:n}=t.segmentation;return U(`section`,{class:`paper`,"aria-hidden":`true`,children:[U(`p`,{children:[pn(t.n_frames/t.fps,1),`, `,t.n_frames,` frames at`,` `,Number(t.fps.toPrecision(5)),` Hz`,typeof n.preset==`string`&&`, segmented by ${n.preset}`]}),U(`h2`,{children:`Repetitions`}),U(Yc,{recording:e})]})}function Qc(e){let t=V(e.peek());return Et(()=>{let{value:n}=e,r=()=>void(t.value=n);(!t.peek()||Qi.value)&&r();let i=setTimeout(r,qc);return()=>clearTimeout(i)}),t}var $c=[.1,.25,.5,1,2,4];function el({curves:e=!1}){let t=Pn(),{playing:n,loop:r,speed:i}=t,[a,o]=n.value?[`pause`,`Pause`]:[`play`,`Play`];return U(`div`,{class:`transport`,role:`toolbar`,"aria-label":`Playing`,children:[U(tl,{buttons:[[`before`,`Segment before`,`Shift + ←`,()=>t.stepSegment(-1)],[`back`,`One frame back`,`←`,()=>t.step(-1)],[a,o,`Space`,()=>ic(t)],[`on`,`One frame on`,`→`,()=>t.step(1)],[`after`,`Segment after`,`Shift + →`,()=>t.stepSegment(1)]]}),U(La,{icon:`loop`,label:`Loop what is marked, else the segment`,keys:`L`,pressed:r.value!==null,onClick:()=>t.toggleLoop()}),U(Ea,{label:`Speed`,value:i.value,options:$c.map(e=>[e,`${e}×`]),onSelect:e=>i.value=e}),U(nl,{}),e&&U(ba,{class:`curves-button`,on:t.curves,title:`Curves and signals over time (G)`,children:`Curves`}),U(tl,{buttons:[[`minus`,`Zoom out`,`−`,()=>t.zoomBy(1/.7)],[`fit`,`Show all`,`0`,()=>void(t.zoom.value=null)],[`plus`,`Zoom in`,`+`,()=>t.zoomBy(.7)]]}),U(La,{icon:`full`,label:`Full screen`,keys:`F`,onClick:Pt})]})}function tl(e){return U(`div`,{class:`group`,children:e.buttons.map(([e,t,n,r],i)=>U(La,{icon:e,label:t,keys:n,onClick:r},i))})}function nl(){let e=Pn(),{duration:t}=e,n=la(e.playhead,e.playing),r=e.getFrameAt(n.value);return U(S,{children:[U(`output`,{class:`clock number`,children:[U(`b`,{children:pn(n.value,2)}),` `,U(`span`,{class:`quiet`,children:[`/ `,pn(t.value,2)]})]}),U(`label`,{class:`clock-frame quiet`,children:[`frame`,U(Fa,{"aria-label":`Frame`,min:0,max:Math.max((e.recording.value?.n_frames??1)-1,0),value:r,onNumber:t=>e.seek(Math.round(t)/e.fps.value)})]}),U(`input`,{type:`range`,class:`scrub`,"aria-label":`Playhead`,"aria-valuetext":pn(n.value,2),min:0,max:t.value,step:.01,value:n.value,onInput:t=>e.seek(Number(t.currentTarget.value))})]})}var rl={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},il={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},al=1e3,ol=1001,sl=1002,cl=1003,ll=1004,ul=1005,dl=1006,fl=1007,pl=1008,ml=1009,hl=1010,gl=1011,_l=1012,vl=1013,yl=1014,bl=1015,xl=1016,Sl=1017,Cl=1018,wl=1020,Tl=35902,El=35899,Dl=1021,Ol=1022,kl=1023,Al=1026,jl=1027,Ml=1028,Nl=1029,Pl=1030,Fl=1031,Il=1033,Ll=33776,Rl=33777,zl=33778,Bl=33779,Vl=35840,Hl=35841,Ul=35842,Wl=35843,Gl=36196,Kl=37492,ql=37496,Jl=37488,Yl=37489,Xl=37490,Zl=37491,Ql=37808,$l=37809,eu=37810,tu=37811,nu=37812,ru=37813,iu=37814,au=37815,ou=37816,su=37817,cu=37818,lu=37819,uu=37820,du=37821,fu=36492,pu=36494,mu=36495,hu=36283,gu=36284,_u=36285,vu=36286,yu=2300,bu=2301,xu=2302,Su=2303,Cu=2400,wu=2401,Tu=2402,Eu=3200,Du=`srgb`,Ou=`srgb-linear`,ku=`linear`,Au=`srgb`,ju=7680,Mu=35044,Nu=`300 es`,Pu=2e3;function Fu(e){for(let t=e.length-1;t>=0;--t)if(e[t]>=65535)return!0;return!1}function Iu(e){return ArrayBuffer.isView(e)&&!(e instanceof DataView)}function Lu(e){return document.createElementNS(`http://www.w3.org/1999/xhtml`,e)}function Ru(){let e=Lu(`canvas`);return e.style.display=`block`,e}var zu={};function Bu(...e){let t=`THREE.`+e.shift();console.log(t,...e)}function Vu(e){let t=e[0];if(typeof t==`string`&&t.startsWith(`TSL:`)){let t=e[1];t&&t.isStackTrace?e[0]+=` `+t.getLocation():e[1]=`Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.`}return e}function K(...e){e=Vu(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.warn(n.getError(t)):console.warn(t,...e)}}function q(...e){e=Vu(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.error(n.getError(t)):console.error(t,...e)}}function Hu(...e){let t=e.join(` `);t in zu||(zu[t]=!0,K(...e))}function Uu(e,t,n){return new Promise(function(r,i){function a(){switch(e.clientWaitSync(t,e.SYNC_FLUSH_COMMANDS_BIT,0)){case e.WAIT_FAILED:i();break;case e.TIMEOUT_EXPIRED:setTimeout(a,n);break;default:r()}}setTimeout(a,n)})}var Wu={0:0,2:6,4:4,3:5,1:1,6:2,7:7,5:3},Gu=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n!==void 0&&n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let r=n[e];if(r!==void 0){let e=r.indexOf(t);e!==-1&&r.splice(e,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let t=n.slice(0);for(let n=0,r=t.length;n<r;n++)t[n].call(this,e);e.target=null}}},Ku=`00.01.02.03.04.05.06.07.08.09.0a.0b.0c.0d.0e.0f.10.11.12.13.14.15.16.17.18.19.1a.1b.1c.1d.1e.1f.20.21.22.23.24.25.26.27.28.29.2a.2b.2c.2d.2e.2f.30.31.32.33.34.35.36.37.38.39.3a.3b.3c.3d.3e.3f.40.41.42.43.44.45.46.47.48.49.4a.4b.4c.4d.4e.4f.50.51.52.53.54.55.56.57.58.59.5a.5b.5c.5d.5e.5f.60.61.62.63.64.65.66.67.68.69.6a.6b.6c.6d.6e.6f.70.71.72.73.74.75.76.77.78.79.7a.7b.7c.7d.7e.7f.80.81.82.83.84.85.86.87.88.89.8a.8b.8c.8d.8e.8f.90.91.92.93.94.95.96.97.98.99.9a.9b.9c.9d.9e.9f.a0.a1.a2.a3.a4.a5.a6.a7.a8.a9.aa.ab.ac.ad.ae.af.b0.b1.b2.b3.b4.b5.b6.b7.b8.b9.ba.bb.bc.bd.be.bf.c0.c1.c2.c3.c4.c5.c6.c7.c8.c9.ca.cb.cc.cd.ce.cf.d0.d1.d2.d3.d4.d5.d6.d7.d8.d9.da.db.dc.dd.de.df.e0.e1.e2.e3.e4.e5.e6.e7.e8.e9.ea.eb.ec.ed.ee.ef.f0.f1.f2.f3.f4.f5.f6.f7.f8.f9.fa.fb.fc.fd.fe.ff`.split(`.`),qu=1234567,Ju=Math.PI/180,Yu=180/Math.PI;function Xu(){let e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0,r=Math.random()*4294967295|0;return(Ku[e&255]+Ku[e>>8&255]+Ku[e>>16&255]+Ku[e>>24&255]+`-`+Ku[t&255]+Ku[t>>8&255]+`-`+Ku[t>>16&15|64]+Ku[t>>24&255]+`-`+Ku[n&63|128]+Ku[n>>8&255]+`-`+Ku[n>>16&255]+Ku[n>>24&255]+Ku[r&255]+Ku[r>>8&255]+Ku[r>>16&255]+Ku[r>>24&255]).toLowerCase()}function J(e,t,n){return Math.max(t,Math.min(n,e))}function Zu(e,t){return(e%t+t)%t}function Qu(e,t,n,r,i){return r+(e-t)*(i-r)/(n-t)}function $u(e,t,n){return e===t?0:(n-e)/(t-e)}function ed(e,t,n){return(1-n)*e+n*t}function td(e,t,n,r){return ed(e,t,1-Math.exp(-n*r))}function nd(e,t=1){return t-Math.abs(Zu(e,t*2)-t)}function rd(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*(3-2*e))}function id(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*e*(e*(e*6-15)+10))}function ad(e,t){return e+Math.floor(Math.random()*(t-e+1))}function od(e,t){return e+Math.random()*(t-e)}function sd(e){return e*(.5-Math.random())}function cd(e){e!==void 0&&(qu=e);let t=qu+=1831565813;return t=Math.imul(t^t>>>15,t|1),t^=t+Math.imul(t^t>>>7,t|61),((t^t>>>14)>>>0)/4294967296}function ld(e){return e*Ju}function ud(e){return e*Yu}function dd(e){return e>0&&Number.isInteger(e)&&2**Math.round(Math.log2(e))===e}function fd(e){return 2**Math.ceil(Math.log(e)/Math.LN2)}function pd(e){return 2**Math.floor(Math.log(e)/Math.LN2)}function md(e,t,n,r,i){let a=Math.cos,o=Math.sin,s=a(n/2),c=o(n/2),l=a((t+r)/2),u=o((t+r)/2),d=a((t-r)/2),f=o((t-r)/2),p=a((r-t)/2),m=o((r-t)/2);switch(i){case`XYX`:e.set(s*u,c*d,c*f,s*l);break;case`YZY`:e.set(c*f,s*u,c*d,s*l);break;case`ZXZ`:e.set(c*d,c*f,s*u,s*l);break;case`XZX`:e.set(s*u,c*m,c*p,s*l);break;case`YXY`:e.set(c*p,s*u,c*m,s*l);break;case`ZYZ`:e.set(c*m,c*p,s*u,s*l);break;default:K(`MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: `+i)}}function hd(e){switch(e.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function gd(e,t){if(t.constructor===Float32Array)return e;let n=hd(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.max(e/n,-1)}function _d(e,t){if(t.constructor===Float32Array)return e;let n=hd(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.round(e*n)}var vd={DEG2RAD:Ju,RAD2DEG:Yu,generateUUID:Xu,clamp:J,euclideanModulo:Zu,mapLinear:Qu,inverseLerp:$u,lerp:ed,damp:td,pingpong:nd,smoothstep:rd,smootherstep:id,randInt:ad,randFloat:od,randFloatSpread:sd,seededRandom:cd,degToRad:ld,radToDeg:ud,isPowerOfTwo:dd,ceilPowerOfTwo:fd,floorPowerOfTwo:pd,setQuaternionFromProperEuler:md,normalize:_d,denormalize:gd},Y=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw Error(`THREE.Vector2: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw Error(`THREE.Vector2: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6],this.y=r[1]*t+r[4]*n+r[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=J(this.x,e.x,t.x),this.y=J(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=J(this.x,e,t),this.y=J(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(J(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(J(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),r=Math.sin(t),i=this.x-e.x,a=this.y-e.y;return this.x=i*n-a*r+e.x,this.y=i*r+a*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},yd=class{constructor(e=0,t=0,n=0,r=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=r}static slerpFlat(e,t,n,r,i,a,o){let s=n[r+0],c=n[r+1],l=n[r+2],u=n[r+3],d=i[a+0],f=i[a+1],p=i[a+2],m=i[a+3];if(u!==m||s!==d||c!==f||l!==p){let e=s*d+c*f+l*p+u*m;e<0&&(d=-d,f=-f,p=-p,m=-m,e=-e);let t=1-o;if(e<.9995){let n=Math.acos(e),r=Math.sin(n);t=Math.sin(t*n)/r,o=Math.sin(o*n)/r,s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o}else{s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o;let e=1/Math.sqrt(s*s+c*c+l*l+u*u);s*=e,c*=e,l*=e,u*=e}}e[t]=s,e[t+1]=c,e[t+2]=l,e[t+3]=u}static multiplyQuaternionsFlat(e,t,n,r,i,a){let o=n[r],s=n[r+1],c=n[r+2],l=n[r+3],u=i[a],d=i[a+1],f=i[a+2],p=i[a+3];return e[t]=o*p+l*u+s*f-c*d,e[t+1]=s*p+l*d+c*u-o*f,e[t+2]=c*p+l*f+o*d-s*u,e[t+3]=l*p-o*u-s*d-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,r){return this._x=e,this._y=t,this._z=n,this._w=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,r=e._y,i=e._z,a=e._order,o=Math.cos,s=Math.sin,c=o(n/2),l=o(r/2),u=o(i/2),d=s(n/2),f=s(r/2),p=s(i/2);switch(a){case`XYZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`YXZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`ZXY`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`ZYX`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`YZX`:this._x=d*l*u+c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u-d*f*p;break;case`XZY`:this._x=d*l*u-c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u+d*f*p;break;default:K(`Quaternion: .setFromEuler() encountered an unknown order: `+a)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,r=Math.sin(n);return this._x=e.x*r,this._y=e.y*r,this._z=e.z*r,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],r=t[4],i=t[8],a=t[1],o=t[5],s=t[9],c=t[2],l=t[6],u=t[10],d=n+o+u;if(d>0){let e=.5/Math.sqrt(d+1);this._w=.25/e,this._x=(l-s)*e,this._y=(i-c)*e,this._z=(a-r)*e}else if(n>o&&n>u){let e=2*Math.sqrt(1+n-o-u);this._w=(l-s)/e,this._x=.25*e,this._y=(r+a)/e,this._z=(i+c)/e}else if(o>u){let e=2*Math.sqrt(1+o-n-u);this._w=(i-c)/e,this._x=(r+a)/e,this._y=.25*e,this._z=(s+l)/e}else{let e=2*Math.sqrt(1+u-n-o);this._w=(a-r)/e,this._x=(i+c)/e,this._y=(s+l)/e,this._z=.25*e}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(J(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let r=Math.min(1,t/n);return this.slerp(e,r),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x*=e,this._y*=e,this._z*=e,this._w*=e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=t._x,s=t._y,c=t._z,l=t._w;return this._x=n*l+a*o+r*c-i*s,this._y=r*l+a*s+i*o-n*c,this._z=i*l+a*c+n*s-r*o,this._w=a*l-n*o-r*s-i*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=this.dot(e);o<0&&(n=-n,r=-r,i=-i,a=-a,o=-o);let s=1-t;if(o<.9995){let e=Math.acos(o),c=Math.sin(e);s=Math.sin(s*e)/c,t=Math.sin(t*e)/c,this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this._onChangeCallback()}else this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),r=Math.sqrt(1-n),i=Math.sqrt(n);return this.set(r*Math.sin(e),r*Math.cos(e),i*Math.sin(t),i*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},X=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw Error(`THREE.Vector3: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw Error(`THREE.Vector3: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(xd.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(xd.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[3]*n+i[6]*r,this.y=i[1]*t+i[4]*n+i[7]*r,this.z=i[2]*t+i[5]*n+i[8]*r,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=e.elements,a=1/(i[3]*t+i[7]*n+i[11]*r+i[15]);return this.x=(i[0]*t+i[4]*n+i[8]*r+i[12])*a,this.y=(i[1]*t+i[5]*n+i[9]*r+i[13])*a,this.z=(i[2]*t+i[6]*n+i[10]*r+i[14])*a,this}applyQuaternion(e){let t=this.x,n=this.y,r=this.z,i=e.x,a=e.y,o=e.z,s=e.w,c=2*(a*r-o*n),l=2*(o*t-i*r),u=2*(i*n-a*t);return this.x=t+s*c+a*u-o*l,this.y=n+s*l+o*c-i*u,this.z=r+s*u+i*l-a*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[4]*n+i[8]*r,this.y=i[1]*t+i[5]*n+i[9]*r,this.z=i[2]*t+i[6]*n+i[10]*r,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=J(this.x,e.x,t.x),this.y=J(this.y,e.y,t.y),this.z=J(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=J(this.x,e,t),this.y=J(this.y,e,t),this.z=J(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(J(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,r=e.y,i=e.z,a=t.x,o=t.y,s=t.z;return this.x=r*s-i*o,this.y=i*a-n*s,this.z=n*o-r*a,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return bd.copy(this).projectOnVector(e),this.sub(bd)}reflect(e){return this.sub(bd.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(J(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,r=this.z-e.z;return t*t+n*n+r*r}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let r=Math.sin(t)*e;return this.x=r*Math.sin(n),this.y=Math.cos(t)*e,this.z=r*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),r=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=r,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},bd=new X,xd=new yd,Z=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,r,i,a,o,s,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c)}set(e,t,n,r,i,a,o,s,c){let l=this.elements;return l[0]=e,l[1]=r,l[2]=o,l[3]=t,l[4]=i,l[5]=s,l[6]=n,l[7]=a,l[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[3],s=n[6],c=n[1],l=n[4],u=n[7],d=n[2],f=n[5],p=n[8],m=r[0],h=r[3],g=r[6],_=r[1],v=r[4],y=r[7],b=r[2],x=r[5],S=r[8];return i[0]=a*m+o*_+s*b,i[3]=a*h+o*v+s*x,i[6]=a*g+o*y+s*S,i[1]=c*m+l*_+u*b,i[4]=c*h+l*v+u*x,i[7]=c*g+l*y+u*S,i[2]=d*m+f*_+p*b,i[5]=d*h+f*v+p*x,i[8]=d*g+f*y+p*S,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8];return t*a*l-t*o*c-n*i*l+n*o*s+r*i*c-r*a*s}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=l*a-o*c,d=o*s-l*i,f=c*i-a*s,p=t*u+n*d+r*f;if(p===0)return this.set(0,0,0,0,0,0,0,0,0);let m=1/p;return e[0]=u*m,e[1]=(r*c-l*n)*m,e[2]=(o*n-r*a)*m,e[3]=d*m,e[4]=(l*t-r*s)*m,e[5]=(r*i-o*t)*m,e[6]=f*m,e[7]=(n*s-c*t)*m,e[8]=(a*t-n*i)*m,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,r,i,a,o){let s=Math.cos(i),c=Math.sin(i);return this.set(n*s,n*c,-n*(s*a+c*o)+a+e,-r*c,r*s,-r*(-c*a+s*o)+o+t,0,0,1),this}scale(e,t){return Hu(`Matrix3: .scale() is deprecated. Use .makeScale() instead.`),this.premultiply(Sd.makeScale(e,t)),this}rotate(e){return Hu(`Matrix3: .rotate() is deprecated. Use .makeRotation() instead.`),this.premultiply(Sd.makeRotation(-e)),this}translate(e,t){return Hu(`Matrix3: .translate() is deprecated. Use .makeTranslation() instead.`),this.premultiply(Sd.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<9;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},Sd=new Z,Cd=new Z().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),wd=new Z().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function Td(){let e={enabled:!0,workingColorSpace:Ou,spaces:{},convert:function(e,t,n){return this.enabled===!1||t===n||!t||!n||(this.spaces[t].transfer===`srgb`&&(e.r=Dd(e.r),e.g=Dd(e.g),e.b=Dd(e.b)),this.spaces[t].primaries!==this.spaces[n].primaries&&(e.applyMatrix3(this.spaces[t].toXYZ),e.applyMatrix3(this.spaces[n].fromXYZ)),this.spaces[n].transfer===`srgb`&&(e.r=Od(e.r),e.g=Od(e.g),e.b=Od(e.b))),e},workingToColorSpace:function(e,t){return this.convert(e,this.workingColorSpace,t)},colorSpaceToWorking:function(e,t){return this.convert(e,t,this.workingColorSpace)},getPrimaries:function(e){return this.spaces[e].primaries},getTransfer:function(e){return e===``?ku:this.spaces[e].transfer},getToneMappingMode:function(e){return this.spaces[e].outputColorSpaceConfig.toneMappingMode||`standard`},getLuminanceCoefficients:function(e,t=this.workingColorSpace){return e.fromArray(this.spaces[t].luminanceCoefficients)},define:function(e){Object.assign(this.spaces,e)},_getMatrix:function(e,t,n){return e.copy(this.spaces[n].fromXYZ).multiply(this.spaces[t].toXYZ)},_getDrawingBufferColorSpace:function(e){return this.spaces[e].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(e=this.workingColorSpace){return this.spaces[e].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],n=[.2126,.7152,.0722],r=[.3127,.329];return e.define({[Ou]:{primaries:t,whitePoint:r,transfer:ku,toXYZ:Cd,fromXYZ:wd,luminanceCoefficients:n,workingColorSpaceConfig:{unpackColorSpace:Du},outputColorSpaceConfig:{drawingBufferColorSpace:Du}},[Du]:{primaries:t,whitePoint:r,transfer:Au,toXYZ:Cd,fromXYZ:wd,luminanceCoefficients:n,outputColorSpaceConfig:{drawingBufferColorSpace:Du}}}),e}var Ed=Td();function Dd(e){return e<.04045?e*.0773993808:(e*.9478672986+.0521327014)**2.4}function Od(e){return e<.0031308?e*12.92:1.055*e**.41666-.055}var kd,Ad=class{static getDataURL(e,t=`image/png`){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>`u`)return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{kd===void 0&&(kd=Lu(`canvas`)),kd.width=e.width,kd.height=e.height;let t=kd.getContext(`2d`);e instanceof ImageData?t.putImageData(e,0,0):t.drawImage(e,0,0,e.width,e.height),n=kd}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap){let t=Lu(`canvas`);t.width=e.width,t.height=e.height;let n=t.getContext(`2d`);n.drawImage(e,0,0,e.width,e.height);let r=n.getImageData(0,0,e.width,e.height),i=r.data;for(let e=0;e<i.length;e++)i[e]=Dd(i[e]/255)*255;return n.putImageData(r,0,0),t}if(e.data){let t=e.data.slice(0);for(let e=0;e<t.length;e++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[e]=Math.floor(Dd(t[e]/255)*255):t[e]=Dd(t[e]);return{data:t,width:e.width,height:e.height}}return K(`ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied.`),e}},jd=0,Md=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:jd++}),this.uuid=Xu(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<`u`&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<`u`&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t===null?e.set(0,0,0):e.set(t.width||0,t.height||0,t.depth||0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:``},r=this.data;if(r!==null){let e;if(Array.isArray(r)){e=[];for(let t=0,n=r.length;t<n;t++)r[t].isDataTexture?e.push(Nd(r[t].image)):e.push(Nd(r[t]))}else e=Nd(r);n.url=e}return t||(e.images[this.uuid]=n),n}};function Nd(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap?Ad.getDataURL(e):e.data?{data:Array.from(e.data),width:e.width,height:e.height,type:e.data.constructor.name}:(K(`Texture: Unable to serialize Texture.`),{})}var Pd=0,Fd=new X,Id=class e extends Gu{constructor(t=e.DEFAULT_IMAGE,n=e.DEFAULT_MAPPING,r=ol,i=ol,a=dl,o=pl,s=kl,c=ml,l=e.DEFAULT_ANISOTROPY,u=``){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Pd++}),this.uuid=Xu(),this.name=``,this.source=new Md(t),this.mipmaps=[],this.mapping=n,this.channel=0,this.wrapS=r,this.wrapT=i,this.magFilter=a,this.minFilter=o,this.anisotropy=l,this.format=s,this.internalFormat=null,this.type=c,this.offset=new Y(0,0),this.repeat=new Y(1,1),this.center=new Y(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new Z,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(t&&t.depth&&t.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Fd).x}get height(){return this.source.getSize(Fd).y}get depth(){return this.source.getSize(Fd).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){K(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?K(`Texture.setValues(): property '${t}' does not exist.`):r&&n&&r.isVector2&&n.isVector2||r&&n&&r.isVector3&&n.isVector3||r&&n&&r.isMatrix3&&n.isMatrix3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:`Texture`,generator:`Texture.toJSON`},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:`dispose`})}transformUv(e){if(this.mapping!==300)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case al:e.x-=Math.floor(e.x);break;case ol:e.x=e.x<0?0:1;break;case sl:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x-=Math.floor(e.x)}if(e.y<0||e.y>1)switch(this.wrapT){case al:e.y-=Math.floor(e.y);break;case ol:e.y=e.y<0?0:1;break;case sl:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y-=Math.floor(e.y)}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};Id.DEFAULT_IMAGE=null,Id.DEFAULT_MAPPING=300,Id.DEFAULT_ANISOTROPY=1;var Ld=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,r=1){this.x=e,this.y=t,this.z=n,this.w=r}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,r){return this.x=e,this.y=t,this.z=n,this.w=r,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw Error(`THREE.Vector4: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw Error(`THREE.Vector4: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w===void 0?1:e.w,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=this.w,a=e.elements;return this.x=a[0]*t+a[4]*n+a[8]*r+a[12]*i,this.y=a[1]*t+a[5]*n+a[9]*r+a[13]*i,this.z=a[2]*t+a[6]*n+a[10]*r+a[14]*i,this.w=a[3]*t+a[7]*n+a[11]*r+a[15]*i,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,r,i,a=.01,o=.1,s=e.elements,c=s[0],l=s[4],u=s[8],d=s[1],f=s[5],p=s[9],m=s[2],h=s[6],g=s[10];if(Math.abs(l-d)<a&&Math.abs(u-m)<a&&Math.abs(p-h)<a){if(Math.abs(l+d)<o&&Math.abs(u+m)<o&&Math.abs(p+h)<o&&Math.abs(c+f+g-3)<o)return this.set(1,0,0,0),this;t=Math.PI;let e=(c+1)/2,s=(f+1)/2,_=(g+1)/2,v=(l+d)/4,y=(u+m)/4,b=(p+h)/4;return e>s&&e>_?e<a?(n=0,r=.707106781,i=.707106781):(n=Math.sqrt(e),r=v/n,i=y/n):s>_?s<a?(n=.707106781,r=0,i=.707106781):(r=Math.sqrt(s),n=v/r,i=b/r):_<a?(n=.707106781,r=.707106781,i=0):(i=Math.sqrt(_),n=y/i,r=b/i),this.set(n,r,i,t),this}let _=Math.sqrt((h-p)*(h-p)+(u-m)*(u-m)+(d-l)*(d-l));return Math.abs(_)<.001&&(_=1),this.x=(h-p)/_,this.y=(u-m)/_,this.z=(d-l)/_,this.w=Math.acos((c+f+g-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=J(this.x,e.x,t.x),this.y=J(this.y,e.y,t.y),this.z=J(this.z,e.z,t.z),this.w=J(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=J(this.x,e,t),this.y=J(this.y,e,t),this.z=J(this.z,e,t),this.w=J(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(J(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Rd=class extends Gu{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:dl,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new Ld(0,0,e,t),this.scissorTest=!1,this.viewport=new Ld(0,0,e,t),this.textures=[];let r=n.count;for(let i=0;i<r;i++)this.textures[i]=new Id({width:e,height:t,depth:n.depth}),this.textures[i].isRenderTargetTexture=!0,this.textures[i].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:dl,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let e=0;e<this.textures.length;e++)this.textures[e].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let r=0,i=this.textures.length;r<i;r++)this.textures[r].image.width=e,this.textures[r].image.height=t,this.textures[r].image.depth=n,this.textures[r].isData3DTexture!==!0&&(this.textures[r].isArrayTexture=this.textures[r].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let n=Object.assign({},e.textures[t].image);this.textures[t].source=new Md(n)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null){if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture}else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:`dispose`})}},zd=class extends Rd{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},Bd=class extends Id{constructor(e=null,t=1,n=1,r=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=cl,this.minFilter=cl,this.wrapR=ol,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}},Vd=class extends Id{constructor(e=null,t=1,n=1,r=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=cl,this.minFilter=cl,this.wrapR=ol,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}},Hd=class e{static{this.prototype.isMatrix4=!0}constructor(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h)}set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){let g=this.elements;return g[0]=e,g[4]=t,g[8]=n,g[12]=r,g[1]=i,g[5]=a,g[9]=o,g[13]=s,g[2]=c,g[6]=l,g[10]=u,g[14]=d,g[3]=f,g[7]=p,g[11]=m,g[15]=h,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new e().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,r=1/Ud.setFromMatrixColumn(e,0).length(),i=1/Ud.setFromMatrixColumn(e,1).length(),a=1/Ud.setFromMatrixColumn(e,2).length();return t[0]=n[0]*r,t[1]=n[1]*r,t[2]=n[2]*r,t[3]=0,t[4]=n[4]*i,t[5]=n[5]*i,t[6]=n[6]*i,t[7]=0,t[8]=n[8]*a,t[9]=n[9]*a,t[10]=n[10]*a,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,r=e.y,i=e.z,a=Math.cos(n),o=Math.sin(n),s=Math.cos(r),c=Math.sin(r),l=Math.cos(i),u=Math.sin(i);if(e.order===`XYZ`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=-s*u,t[8]=c,t[1]=n+r*c,t[5]=e-i*c,t[9]=-o*s,t[2]=i-e*c,t[6]=r+n*c,t[10]=a*s}else if(e.order===`YXZ`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e+i*o,t[4]=r*o-n,t[8]=a*c,t[1]=a*u,t[5]=a*l,t[9]=-o,t[2]=n*o-r,t[6]=i+e*o,t[10]=a*s}else if(e.order===`ZXY`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e-i*o,t[4]=-a*u,t[8]=r+n*o,t[1]=n+r*o,t[5]=a*l,t[9]=i-e*o,t[2]=-a*c,t[6]=o,t[10]=a*s}else if(e.order===`ZYX`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=r*c-n,t[8]=e*c+i,t[1]=s*u,t[5]=i*c+e,t[9]=n*c-r,t[2]=-c,t[6]=o*s,t[10]=a*s}else if(e.order===`YZX`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=i-e*u,t[8]=r*u+n,t[1]=u,t[5]=a*l,t[9]=-o*l,t[2]=-c*l,t[6]=n*u+r,t[10]=e-i*u}else if(e.order===`XZY`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=-u,t[8]=c*l,t[1]=e*u+i,t[5]=a*l,t[9]=n*u-r,t[2]=r*u-n,t[6]=o*l,t[10]=i*u+e}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(Gd,e,Kd)}lookAt(e,t,n){let r=this.elements;return Yd.subVectors(e,t),Yd.lengthSq()===0&&(Yd.z=1),Yd.normalize(),qd.crossVectors(n,Yd),qd.lengthSq()===0&&(Math.abs(n.z)===1?Yd.x+=1e-4:Yd.z+=1e-4,Yd.normalize(),qd.crossVectors(n,Yd)),qd.normalize(),Jd.crossVectors(Yd,qd),r[0]=qd.x,r[4]=Jd.x,r[8]=Yd.x,r[1]=qd.y,r[5]=Jd.y,r[9]=Yd.y,r[2]=qd.z,r[6]=Jd.z,r[10]=Yd.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[4],s=n[8],c=n[12],l=n[1],u=n[5],d=n[9],f=n[13],p=n[2],m=n[6],h=n[10],g=n[14],_=n[3],v=n[7],y=n[11],b=n[15],x=r[0],S=r[4],C=r[8],w=r[12],T=r[1],E=r[5],D=r[9],O=r[13],k=r[2],A=r[6],j=r[10],ee=r[14],M=r[3],te=r[7],ne=r[11],N=r[15];return i[0]=a*x+o*T+s*k+c*M,i[4]=a*S+o*E+s*A+c*te,i[8]=a*C+o*D+s*j+c*ne,i[12]=a*w+o*O+s*ee+c*N,i[1]=l*x+u*T+d*k+f*M,i[5]=l*S+u*E+d*A+f*te,i[9]=l*C+u*D+d*j+f*ne,i[13]=l*w+u*O+d*ee+f*N,i[2]=p*x+m*T+h*k+g*M,i[6]=p*S+m*E+h*A+g*te,i[10]=p*C+m*D+h*j+g*ne,i[14]=p*w+m*O+h*ee+g*N,i[3]=_*x+v*T+y*k+b*M,i[7]=_*S+v*E+y*A+b*te,i[11]=_*C+v*D+y*j+b*ne,i[15]=_*w+v*O+y*ee+b*N,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[12],a=e[1],o=e[5],s=e[9],c=e[13],l=e[2],u=e[6],d=e[10],f=e[14],p=e[3],m=e[7],h=e[11],g=e[15],_=s*f-c*d,v=o*f-c*u,y=o*d-s*u,b=a*f-c*l,x=a*d-s*l,S=a*u-o*l;return t*(m*_-h*v+g*y)-n*(p*_-h*b+g*x)+r*(p*v-m*b+g*S)-i*(p*y-m*x+h*S)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[1],a=e[5],o=e[9],s=e[2],c=e[6],l=e[10];return t*(a*l-o*c)-n*(i*l-o*s)+r*(i*c-a*s)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let r=this.elements;return e.isVector3?(r[12]=e.x,r[13]=e.y,r[14]=e.z):(r[12]=e,r[13]=t,r[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=e[9],d=e[10],f=e[11],p=e[12],m=e[13],h=e[14],g=e[15],_=t*o-n*a,v=t*s-r*a,y=t*c-i*a,b=n*s-r*o,x=n*c-i*o,S=r*c-i*s,C=l*m-u*p,w=l*h-d*p,T=l*g-f*p,E=u*h-d*m,D=u*g-f*m,O=d*g-f*h,k=_*O-v*D+y*E+b*T-x*w+S*C;if(k===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let A=1/k;return e[0]=(o*O-s*D+c*E)*A,e[1]=(r*D-n*O-i*E)*A,e[2]=(m*S-h*x+g*b)*A,e[3]=(d*x-u*S-f*b)*A,e[4]=(s*T-a*O-c*w)*A,e[5]=(t*O-r*T+i*w)*A,e[6]=(h*y-p*S-g*v)*A,e[7]=(l*S-d*y+f*v)*A,e[8]=(a*D-o*T+c*C)*A,e[9]=(n*T-t*D-i*C)*A,e[10]=(p*x-m*y+g*_)*A,e[11]=(u*y-l*x-f*_)*A,e[12]=(o*w-a*E-s*C)*A,e[13]=(t*E-n*w+r*C)*A,e[14]=(m*v-p*b-h*_)*A,e[15]=(l*b-u*v+d*_)*A,this}scale(e){let t=this.elements,n=e.x,r=e.y,i=e.z;return t[0]*=n,t[4]*=r,t[8]*=i,t[1]*=n,t[5]*=r,t[9]*=i,t[2]*=n,t[6]*=r,t[10]*=i,t[3]*=n,t[7]*=r,t[11]*=i,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],r=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,r))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),r=Math.sin(t),i=1-n,a=e.x,o=e.y,s=e.z,c=i*a,l=i*o;return this.set(c*a+n,c*o-r*s,c*s+r*o,0,c*o+r*s,l*o+n,l*s-r*a,0,c*s-r*o,l*s+r*a,i*s*s+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,r,i,a){return this.set(1,n,i,0,e,1,a,0,t,r,1,0,0,0,0,1),this}compose(e,t,n){let r=this.elements,i=t._x,a=t._y,o=t._z,s=t._w,c=i+i,l=a+a,u=o+o,d=i*c,f=i*l,p=i*u,m=a*l,h=a*u,g=o*u,_=s*c,v=s*l,y=s*u,b=n.x,x=n.y,S=n.z;return r[0]=(1-(m+g))*b,r[1]=(f+y)*b,r[2]=(p-v)*b,r[3]=0,r[4]=(f-y)*x,r[5]=(1-(d+g))*x,r[6]=(h+_)*x,r[7]=0,r[8]=(p+v)*S,r[9]=(h-_)*S,r[10]=(1-(d+m))*S,r[11]=0,r[12]=e.x,r[13]=e.y,r[14]=e.z,r[15]=1,this}decompose(e,t,n){let r=this.elements;e.x=r[12],e.y=r[13],e.z=r[14];let i=this.determinantAffine();if(i===0)return n.set(1,1,1),t.identity(),this;let a=Ud.set(r[0],r[1],r[2]).length(),o=Ud.set(r[4],r[5],r[6]).length(),s=Ud.set(r[8],r[9],r[10]).length();i<0&&(a=-a),Wd.copy(this);let c=1/a,l=1/o,u=1/s;return Wd.elements[0]*=c,Wd.elements[1]*=c,Wd.elements[2]*=c,Wd.elements[4]*=l,Wd.elements[5]*=l,Wd.elements[6]*=l,Wd.elements[8]*=u,Wd.elements[9]*=u,Wd.elements[10]*=u,t.setFromRotationMatrix(Wd),n.x=a,n.y=o,n.z=s,this}makePerspective(e,t,n,r,i,a,o=Pu,s=!1){let c=this.elements,l=2*i/(t-e),u=2*i/(n-r),d=(t+e)/(t-e),f=(n+r)/(n-r),p,m;if(s)p=i/(a-i),m=a*i/(a-i);else if(o===2e3)p=-(a+i)/(a-i),m=-2*a*i/(a-i);else if(o===2001)p=-a/(a-i),m=-a*i/(a-i);else throw Error(`THREE.Matrix4.makePerspective(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=d,c[12]=0,c[1]=0,c[5]=u,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,r,i,a,o=Pu,s=!1){let c=this.elements,l=2/(t-e),u=2/(n-r),d=-(t+e)/(t-e),f=-(n+r)/(n-r),p,m;if(s)p=1/(a-i),m=a/(a-i);else if(o===2e3)p=-2/(a-i),m=-(a+i)/(a-i);else if(o===2001)p=-1/(a-i),m=-i/(a-i);else throw Error(`THREE.Matrix4.makeOrthographic(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=0,c[12]=d,c[1]=0,c[5]=u,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<16;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},Ud=new X,Wd=new Hd,Gd=new X(0,0,0),Kd=new X(1,1,1),qd=new X,Jd=new X,Yd=new X,Xd=new Hd,Zd=new yd,Qd=class e{constructor(t=0,n=0,r=0,i=e.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=n,this._z=r,this._order=i}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,r=this._order){return this._x=e,this._y=t,this._z=n,this._order=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let r=e.elements,i=r[0],a=r[4],o=r[8],s=r[1],c=r[5],l=r[9],u=r[2],d=r[6],f=r[10];switch(t){case`XYZ`:this._y=Math.asin(J(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-l,f),this._z=Math.atan2(-a,i)):(this._x=Math.atan2(d,c),this._z=0);break;case`YXZ`:this._x=Math.asin(-J(l,-1,1)),Math.abs(l)<.9999999?(this._y=Math.atan2(o,f),this._z=Math.atan2(s,c)):(this._y=Math.atan2(-u,i),this._z=0);break;case`ZXY`:this._x=Math.asin(J(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(-u,f),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(s,i));break;case`ZYX`:this._y=Math.asin(-J(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(d,f),this._z=Math.atan2(s,i)):(this._x=0,this._z=Math.atan2(-a,c));break;case`YZX`:this._z=Math.asin(J(s,-1,1)),Math.abs(s)<.9999999?(this._x=Math.atan2(-l,c),this._y=Math.atan2(-u,i)):(this._x=0,this._y=Math.atan2(o,f));break;case`XZY`:this._z=Math.asin(-J(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(d,c),this._y=Math.atan2(o,i)):(this._x=Math.atan2(-l,f),this._y=0);break;default:K(`Euler: .setFromRotationMatrix() encountered an unknown order: `+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return Xd.makeRotationFromQuaternion(e),this.setFromRotationMatrix(Xd,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return Zd.setFromEuler(this),this.setFromQuaternion(Zd,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Qd.DEFAULT_ORDER=`XYZ`;var $d=class{constructor(){this.mask=1}set(e){this.mask=1<<e>>>0}enable(e){this.mask|=1<<e}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e}disable(e){this.mask&=~(1<<e)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return!!(this.mask&1<<e)}},ef=0,tf=new X,nf=new yd,rf=new Hd,af=new X,of=new X,sf=new X,cf=new yd,lf=new X(1,0,0),uf=new X(0,1,0),df=new X(0,0,1),ff={type:`added`},pf={type:`removed`},mf={type:`childadded`,child:null},hf={type:`childremoved`,child:null},gf=class e extends Gu{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:ef++}),this.uuid=Xu(),this.name=``,this.type=`Object3D`,this.parent=null,this.children=[],this.up=e.DEFAULT_UP.clone();let t=new X,n=new Qd,r=new yd,i=new X(1,1,1);function a(){r.setFromEuler(n,!1)}function o(){n.setFromQuaternion(r,void 0,!1)}n._onChange(a),r._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:n},quaternion:{configurable:!0,enumerable:!0,value:r},scale:{configurable:!0,enumerable:!0,value:i},modelViewMatrix:{value:new Hd},normalMatrix:{value:new Z}}),this.matrix=new Hd,this.matrixWorld=new Hd,this.matrixAutoUpdate=e.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=e.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new $d,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return nf.setFromAxisAngle(e,t),this.quaternion.multiply(nf),this}rotateOnWorldAxis(e,t){return nf.setFromAxisAngle(e,t),this.quaternion.premultiply(nf),this}rotateX(e){return this.rotateOnAxis(lf,e)}rotateY(e){return this.rotateOnAxis(uf,e)}rotateZ(e){return this.rotateOnAxis(df,e)}translateOnAxis(e,t){return tf.copy(e).applyQuaternion(this.quaternion),this.position.add(tf.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(lf,e)}translateY(e){return this.translateOnAxis(uf,e)}translateZ(e){return this.translateOnAxis(df,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(rf.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?af.copy(e):af.set(e,t,n);let r=this.parent;this.updateWorldMatrix(!0,!1),of.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?rf.lookAt(of,af,this.up):rf.lookAt(af,of,this.up),this.quaternion.setFromRotationMatrix(rf),r&&(rf.extractRotation(r.matrixWorld),nf.setFromRotationMatrix(rf),this.quaternion.premultiply(nf.invert()))}add(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return e===this?(q(`Object3D.add: object can't be added as a child of itself.`,e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(ff),mf.child=e,this.dispatchEvent(mf),mf.child=null):q(`Object3D.add: object not an instance of THREE.Object3D.`,e),this)}remove(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.remove(arguments[e]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(pf),hf.child=e,this.dispatchEvent(hf),hf.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),rf.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),rf.multiply(e.parent.matrixWorld)),e.applyMatrix4(rf),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(ff),mf.child=e,this.dispatchEvent(mf),mf.child=null,this}getObjectById(e){return this.getObjectByProperty(`id`,e)}getObjectByName(e){return this.getObjectByProperty(`name`,e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,r=this.children.length;n<r;n++){let r=this.children[n].getObjectByProperty(e,t);if(r!==void 0)return r}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let r=this.children;for(let i=0,a=r.length;i<a;i++)r[i].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(of,e,sf),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(of,cf,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,r=e.z,i=this.matrix.elements;i[12]+=t-i[0]*t-i[4]*n-i[8]*r,i[13]+=n-i[1]*t-i[5]*n-i[9]*r,i[14]+=r-i[2]*t-i[6]*n-i[10]*r}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let r=this.parent;if(e===!0&&r!==null&&r.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let e=this.children;for(let t=0,r=e.length;t<r;t++)e[t].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e==`string`,n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:`Object`,generator:`Object3D.toJSON`});let r={};r.uuid=this.uuid,r.type=this.type,r.name=this.name,r.castShadow=this.castShadow,r.receiveShadow=this.receiveShadow,r.visible=this.visible,r.frustumCulled=this.frustumCulled,r.renderOrder=this.renderOrder,r.static=this.static,r.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(r.userData=this.userData),r.layers=this.layers.mask,r.matrix=this.matrix.toArray(),r.up=this.up.toArray(),this.pivot!==null&&(r.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(r.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(r.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(r.type=`InstancedMesh`,r.count=this.count,r.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(r.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(r.type=`BatchedMesh`,r.perObjectFrustumCulled=this.perObjectFrustumCulled,r.sortObjects=this.sortObjects,r.drawRanges=this._drawRanges,r.reservedRanges=this._reservedRanges,r.geometryInfo=this._geometryInfo.map(e=>({...e,boundingBox:e.boundingBox?e.boundingBox.toJSON():void 0,boundingSphere:e.boundingSphere?e.boundingSphere.toJSON():void 0})),r.instanceInfo=this._instanceInfo.map(e=>({...e})),r.availableInstanceIds=this._availableInstanceIds.slice(),r.availableGeometryIds=this._availableGeometryIds.slice(),r.nextIndexStart=this._nextIndexStart,r.nextVertexStart=this._nextVertexStart,r.geometryCount=this._geometryCount,r.maxInstanceCount=this._maxInstanceCount,r.maxVertexCount=this._maxVertexCount,r.maxIndexCount=this._maxIndexCount,r.geometryInitialized=this._geometryInitialized,r.matricesTexture=this._matricesTexture.toJSON(e),r.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(r.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(r.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(r.boundingBox=this.boundingBox.toJSON()));function i(t,n){return t[n.uuid]===void 0&&(t[n.uuid]=n.toJSON(e)),n.uuid}if(this.isScene)this.background&&(this.background.isColor?r.background=this.background.toJSON():this.background.isTexture&&(r.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(r.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){r.geometry=i(e.geometries,this.geometry);let t=this.geometry.parameters;if(t!==void 0&&t.shapes!==void 0){let n=t.shapes;if(Array.isArray(n))for(let t=0,r=n.length;t<r;t++){let r=n[t];i(e.shapes,r)}else i(e.shapes,n)}}if(this.isSkinnedMesh&&(r.bindMode=this.bindMode,r.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(i(e.skeletons,this.skeleton),r.skeleton=this.skeleton.uuid)),this.material!==void 0){if(Array.isArray(this.material)){let t=[];for(let n=0,r=this.material.length;n<r;n++)t.push(i(e.materials,this.material[n]));r.material=t}else r.material=i(e.materials,this.material)}if(this.children.length>0){r.children=[];for(let t=0;t<this.children.length;t++)r.children.push(this.children[t].toJSON(e).object)}if(this.animations.length>0){r.animations=[];for(let t=0;t<this.animations.length;t++){let n=this.animations[t];r.animations.push(i(e.animations,n))}}if(t){let t=a(e.geometries),r=a(e.materials),i=a(e.textures),o=a(e.images),s=a(e.shapes),c=a(e.skeletons),l=a(e.animations),u=a(e.nodes);t.length>0&&(n.geometries=t),r.length>0&&(n.materials=r),i.length>0&&(n.textures=i),o.length>0&&(n.images=o),s.length>0&&(n.shapes=s),c.length>0&&(n.skeletons=c),l.length>0&&(n.animations=l),u.length>0&&(n.nodes=u)}return n.object=r,n;function a(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot===null?null:e.pivot.clone(),this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let t=0;t<e.children.length;t++){let n=e.children[t];this.add(n.clone())}return this}dispose(){this.dispatchEvent({type:`dispose`})}};gf.DEFAULT_UP=new X(0,1,0),gf.DEFAULT_MATRIX_AUTO_UPDATE=!0,gf.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var _f=class extends gf{constructor(){super(),this.isGroup=!0,this.type=`Group`}},vf={type:`move`},yf=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new _f,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new _f,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new X,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new X),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new _f,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new X,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new X,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:`connected`,data:e}),this}disconnect(e){return this.dispatchEvent({type:`disconnected`,data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let r=null,i=null,a=null,o=this._targetRay,s=this._grip,c=this._hand;if(e&&t.session.visibilityState!==`visible-blurred`){if(c&&e.hand){a=!0;for(let r of e.hand.values()){let e=t.getJointPose(r,n),i=this._getHandJoint(c,r);e!==null&&(i.matrix.fromArray(e.transform.matrix),i.matrix.decompose(i.position,i.quaternion,i.scale),i.matrixWorldNeedsUpdate=!0,i.jointRadius=e.radius),i.visible=e!==null}let r=c.joints[`index-finger-tip`],i=c.joints[`thumb-tip`],o=r.position.distanceTo(i.position);c.inputState.pinching&&o>.025?(c.inputState.pinching=!1,this.dispatchEvent({type:`pinchend`,handedness:e.handedness,target:this})):!c.inputState.pinching&&o<=.015&&(c.inputState.pinching=!0,this.dispatchEvent({type:`pinchstart`,handedness:e.handedness,target:this}))}else s!==null&&e.gripSpace&&(i=t.getPose(e.gripSpace,n),i!==null&&(s.matrix.fromArray(i.transform.matrix),s.matrix.decompose(s.position,s.quaternion,s.scale),s.matrixWorldNeedsUpdate=!0,i.linearVelocity?(s.hasLinearVelocity=!0,s.linearVelocity.copy(i.linearVelocity)):s.hasLinearVelocity=!1,i.angularVelocity?(s.hasAngularVelocity=!0,s.angularVelocity.copy(i.angularVelocity)):s.hasAngularVelocity=!1,s.eventsEnabled&&s.dispatchEvent({type:`gripUpdated`,data:e,target:this})));o!==null&&(r=t.getPose(e.targetRaySpace,n),r===null&&i!==null&&(r=i),r!==null&&(o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,r.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(r.linearVelocity)):o.hasLinearVelocity=!1,r.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(r.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent(vf)))}return o!==null&&(o.visible=r!==null),s!==null&&(s.visible=i!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new _f;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},bf={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},xf={h:0,s:0,l:0},Sf={h:0,s:0,l:0};function Cf(e,t,n){return n<0&&(n+=1),n>1&&--n,n<1/6?e+(t-e)*6*n:n<1/2?t:n<2/3?e+(t-e)*6*(2/3-n):e}var wf=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let t=e;t&&t.isColor?this.copy(t):typeof t==`number`?this.setHex(t):typeof t==`string`&&this.setStyle(t)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=Du){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,Ed.colorSpaceToWorking(this,t),this}setRGB(e,t,n,r=Ed.workingColorSpace){return this.r=e,this.g=t,this.b=n,Ed.colorSpaceToWorking(this,r),this}setHSL(e,t,n,r=Ed.workingColorSpace){if(e=Zu(e,1),t=J(t,0,1),n=J(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,i=2*n-r;this.r=Cf(i,r,e+1/3),this.g=Cf(i,r,e),this.b=Cf(i,r,e-1/3)}return Ed.colorSpaceToWorking(this,r),this}setStyle(e,t=Du){function n(t){t!==void 0&&parseFloat(t)<1&&K(`Color: Alpha component of `+e+` will be ignored.`)}let r;if(r=/^(\w+)\(([^\)]*)\)/.exec(e)){let i,a=r[1],o=r[2];switch(a){case`rgb`:case`rgba`:if(i=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(255,parseInt(i[1],10))/255,Math.min(255,parseInt(i[2],10))/255,Math.min(255,parseInt(i[3],10))/255,t);if(i=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(100,parseFloat(i[1]))/100,Math.min(100,parseFloat(i[2]))/100,Math.min(100,parseFloat(i[3]))/100,t);break;case`hsl`:case`hsla`:if(i=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setHSL(parseFloat(i[1])/360,parseFloat(i[2])/100,parseFloat(i[3])/100,t);break;default:K(`Color: Unknown color model `+e)}}else if(r=/^\#([A-Fa-f\d]+)$/.exec(e)){let n=r[1],i=n.length;if(i===3)return this.setRGB(parseInt(n.charAt(0),16)/15,parseInt(n.charAt(1),16)/15,parseInt(n.charAt(2),16)/15,t);if(i===6)return this.setHex(parseInt(n,16),t);K(`Color: Invalid hex color `+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=Du){let n=bf[e.toLowerCase()];return n===void 0?K(`Color: Unknown color `+e):this.setHex(n,t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=Dd(e.r),this.g=Dd(e.g),this.b=Dd(e.b),this}copyLinearToSRGB(e){return this.r=Od(e.r),this.g=Od(e.g),this.b=Od(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=Du){return Ed.workingToColorSpace(Tf.copy(this),e),Math.round(J(Tf.r*255,0,255))*65536+Math.round(J(Tf.g*255,0,255))*256+Math.round(J(Tf.b*255,0,255))}getHexString(e=Du){return(`000000`+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=Ed.workingColorSpace){Ed.workingToColorSpace(Tf.copy(this),t);let n=Tf.r,r=Tf.g,i=Tf.b,a=Math.max(n,r,i),o=Math.min(n,r,i),s,c,l=(o+a)/2;if(o===a)s=0,c=0;else{let e=a-o;switch(c=l<=.5?e/(a+o):e/(2-a-o),a){case n:s=(r-i)/e+(r<i?6:0);break;case r:s=(i-n)/e+2;break;case i:s=(n-r)/e+4}s/=6}return e.h=s,e.s=c,e.l=l,e}getRGB(e,t=Ed.workingColorSpace){return Ed.workingToColorSpace(Tf.copy(this),t),e.r=Tf.r,e.g=Tf.g,e.b=Tf.b,e}getStyle(e=Du){Ed.workingToColorSpace(Tf.copy(this),e);let t=Tf.r,n=Tf.g,r=Tf.b;return e===`srgb`?`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(r*255)})`:`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${r.toFixed(3)})`}offsetHSL(e,t,n){return this.getHSL(xf),this.setHSL(xf.h+e,xf.s+t,xf.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(xf),e.getHSL(Sf);let n=ed(xf.h,Sf.h,t),r=ed(xf.s,Sf.s,t),i=ed(xf.l,Sf.l,t);return this.setHSL(n,r,i),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,r=this.b,i=e.elements;return this.r=i[0]*t+i[3]*n+i[6]*r,this.g=i[1]*t+i[4]*n+i[7]*r,this.b=i[2]*t+i[5]*n+i[8]*r,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Tf=new wf;wf.NAMES=bf;var Ef=class extends gf{constructor(){super(),this.isScene=!0,this.type=`Scene`,this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Qd,this.environmentIntensity=1,this.environmentRotation=new Qd,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background===null?null:e.background.clone(),this.environment=e.environment===null?null:e.environment.clone(),this.fog=e.fog===null?null:e.fog.clone(),this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial===null?null:e.overrideMaterial.clone(),this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},Df=new X,Of=new X,kf=new X,Af=new X,jf=new X,Mf=new X,Nf=new X,Pf=new X,Ff=new X,If=new X,Lf=new Ld,Rf=new Ld,zf=new Ld,Bf=class e{constructor(e=new X,t=new X,n=new X){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,r){r.subVectors(n,t),Df.subVectors(e,t),r.cross(Df);let i=r.lengthSq();return i>0?r.multiplyScalar(1/Math.sqrt(i)):r.set(0,0,0)}static getBarycoord(e,t,n,r,i){Df.subVectors(r,t),Of.subVectors(n,t),kf.subVectors(e,t);let a=Df.dot(Df),o=Df.dot(Of),s=Df.dot(kf),c=Of.dot(Of),l=Of.dot(kf),u=a*c-o*o;if(u===0)return i.set(0,0,0),null;let d=1/u,f=(c*s-o*l)*d,p=(a*l-o*s)*d;return i.set(1-f-p,p,f)}static containsPoint(e,t,n,r){return this.getBarycoord(e,t,n,r,Af)!==null&&Af.x>=0&&Af.y>=0&&Af.x+Af.y<=1}static getInterpolation(e,t,n,r,i,a,o,s){return this.getBarycoord(e,t,n,r,Af)===null?(s.x=0,s.y=0,`z`in s&&(s.z=0),`w`in s&&(s.w=0),null):(s.setScalar(0),s.addScaledVector(i,Af.x),s.addScaledVector(a,Af.y),s.addScaledVector(o,Af.z),s)}static getInterpolatedAttribute(e,t,n,r,i,a){return Lf.setScalar(0),Rf.setScalar(0),zf.setScalar(0),Lf.fromBufferAttribute(e,t),Rf.fromBufferAttribute(e,n),zf.fromBufferAttribute(e,r),a.setScalar(0),a.addScaledVector(Lf,i.x),a.addScaledVector(Rf,i.y),a.addScaledVector(zf,i.z),a}static isFrontFacing(e,t,n,r){return Df.subVectors(n,t),Of.subVectors(e,t),Df.cross(Of).dot(r)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,r){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[r]),this}setFromAttributeAndIndices(e,t,n,r){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,r),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return Df.subVectors(this.c,this.b),Of.subVectors(this.a,this.b),Df.cross(Of).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return e.getNormal(this.a,this.b,this.c,t)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,n){return e.getBarycoord(t,this.a,this.b,this.c,n)}getInterpolation(t,n,r,i,a){return e.getInterpolation(t,this.a,this.b,this.c,n,r,i,a)}containsPoint(t){return e.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return e.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,r=this.b,i=this.c,a,o;jf.subVectors(r,n),Mf.subVectors(i,n),Pf.subVectors(e,n);let s=jf.dot(Pf),c=Mf.dot(Pf);if(s<=0&&c<=0)return t.copy(n);Ff.subVectors(e,r);let l=jf.dot(Ff),u=Mf.dot(Ff);if(l>=0&&u<=l)return t.copy(r);let d=s*u-l*c;if(d<=0&&s>=0&&l<=0&&s-l>0)return a=s/(s-l),t.copy(n).addScaledVector(jf,a);If.subVectors(e,i);let f=jf.dot(If),p=Mf.dot(If);if(p>=0&&f<=p)return t.copy(i);let m=f*c-s*p;if(m<=0&&c>=0&&p<=0)return o=c/(c-p),t.copy(n).addScaledVector(Mf,o);let h=l*p-f*u;if(h<=0&&u-l>=0&&f-p>=0)return Nf.subVectors(i,r),o=(u-l)/(u-l+(f-p)),t.copy(r).addScaledVector(Nf,o);let g=1/(h+m+d);return a=m*g,o=d*g,t.copy(n).addScaledVector(jf,a).addScaledVector(Mf,o)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},Vf=class{constructor(e=new X(1/0,1/0,1/0),t=new X(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(Uf.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(Uf.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=Uf.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute(`position`);if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let t=0,n=r.count;t<n;t++)e.isMesh===!0?e.getVertexPosition(t,Uf):Uf.fromBufferAttribute(r,t),Uf.applyMatrix4(e.matrixWorld),this.expandByPoint(Uf);else e.boundingBox===void 0?(n.boundingBox===null&&n.computeBoundingBox(),Wf.copy(n.boundingBox)):(e.boundingBox===null&&e.computeBoundingBox(),Wf.copy(e.boundingBox)),Wf.applyMatrix4(e.matrixWorld),this.union(Wf)}let r=e.children;for(let e=0,n=r.length;e<n;e++)this.expandByObject(r[e],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Uf),Uf.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(Zf),Qf.subVectors(this.max,Zf),Gf.subVectors(e.a,Zf),Kf.subVectors(e.b,Zf),qf.subVectors(e.c,Zf),Jf.subVectors(Kf,Gf),Yf.subVectors(qf,Kf),Xf.subVectors(Gf,qf);let t=[0,-Jf.z,Jf.y,0,-Yf.z,Yf.y,0,-Xf.z,Xf.y,Jf.z,0,-Jf.x,Yf.z,0,-Yf.x,Xf.z,0,-Xf.x,-Jf.y,Jf.x,0,-Yf.y,Yf.x,0,-Xf.y,Xf.x,0];return!tp(t,Gf,Kf,qf,Qf)||(t=[1,0,0,0,1,0,0,0,1],!tp(t,Gf,Kf,qf,Qf))?!1:($f.crossVectors(Jf,Yf),t=[$f.x,$f.y,$f.z],tp(t,Gf,Kf,qf,Qf))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Uf).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Uf).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()||(Hf[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Hf[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Hf[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Hf[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Hf[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Hf[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Hf[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Hf[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Hf)),this}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Hf=[new X,new X,new X,new X,new X,new X,new X,new X],Uf=new X,Wf=new Vf,Gf=new X,Kf=new X,qf=new X,Jf=new X,Yf=new X,Xf=new X,Zf=new X,Qf=new X,$f=new X,ep=new X;function tp(e,t,n,r,i){for(let a=0,o=e.length-3;a<=o;a+=3){ep.fromArray(e,a);let o=i.x*Math.abs(ep.x)+i.y*Math.abs(ep.y)+i.z*Math.abs(ep.z),s=t.dot(ep),c=n.dot(ep),l=r.dot(ep);if(Math.max(-Math.max(s,c,l),Math.min(s,c,l))>o)return!1}return!0}var np=new X,rp=new Y,ip=0,ap=class extends Gu{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw TypeError(`THREE.BufferAttribute: array should be a Typed Array.`);this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:ip++}),this.name=``,this.array=e,this.itemSize=t,this.count=e===void 0?0:e.length/t,this.normalized=n,this.usage=Mu,this.updateRanges=[],this.gpuType=bl,this.version=0,this._normalizationScale=e===void 0?void 0:hd(e)}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let r=0,i=this.itemSize;r<i;r++)this.array[e+r]=t.array[n+r];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)rp.fromBufferAttribute(this,t),rp.applyMatrix3(e),this.setXY(t,rp.x,rp.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)np.fromBufferAttribute(this,t),np.applyMatrix3(e),this.setXYZ(t,np.x,np.y,np.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)np.fromBufferAttribute(this,t),np.applyMatrix4(e),this.setXYZ(t,np.x,np.y,np.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)np.fromBufferAttribute(this,t),np.applyNormalMatrix(e),this.setXYZ(t,np.x,np.y,np.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)np.fromBufferAttribute(this,t),np.transformDirection(e),this.setXYZ(t,np.x,np.y,np.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this.array[e+3]=i,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:`dispose`})}_denormalize(e){let t=this._normalizationScale;return t===void 0?gd(e,this.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?_d(e,this.array):Math.round(e*t)}},op=class extends ap{constructor(e,t,n){super(new Uint16Array(e),t,n)}},sp=class extends ap{constructor(e,t,n){super(new Uint32Array(e),t,n)}},cp=class extends ap{constructor(e,t,n){super(new Float32Array(e),t,n)}},lp=new Vf,up=new X,dp=new X,fp=class{constructor(e=new X,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t===void 0?lp.setFromPoints(e).getCenter(n):n.copy(t);let r=0;for(let t=0,i=e.length;t<i;t++)r=Math.max(r,n.distanceToSquared(e[t]));return this.radius=Math.sqrt(r),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius*=e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;up.subVectors(e,this.center);let t=up.lengthSq();if(t>this.radius*this.radius){let e=Math.sqrt(t),n=(e-this.radius)*.5;this.center.addScaledVector(up,n/e),this.radius+=n}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(dp.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(up.copy(e.center).add(dp)),this.expandByPoint(up.copy(e.center).sub(dp))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},pp=0,mp=new Hd,hp=new gf,gp=new X,_p=new Vf,vp=new Vf,yp=new X,bp=class e extends Gu{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:pp++}),this.uuid=Xu(),this.name=``,this.type=`BufferGeometry`,this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return this.index=Array.isArray(e)?new(Fu(e)?sp:op)(e,1):e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let t=new Z().getNormalMatrix(e);n.applyNormalMatrix(t),n.needsUpdate=!0}let r=this.attributes.tangent;return r!==void 0&&(r.transformDirection(e),r.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return mp.makeRotationFromQuaternion(e),this.applyMatrix4(mp),this}rotateX(e){return mp.makeRotationX(e),this.applyMatrix4(mp),this}rotateY(e){return mp.makeRotationY(e),this.applyMatrix4(mp),this}rotateZ(e){return mp.makeRotationZ(e),this.applyMatrix4(mp),this}translate(e,t,n){return mp.makeTranslation(e,t,n),this.applyMatrix4(mp),this}scale(e,t,n){return mp.makeScale(e,t,n),this.applyMatrix4(mp),this}lookAt(e){return hp.lookAt(e),hp.updateMatrix(),this.applyMatrix4(hp.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(gp).negate(),this.translate(gp.x,gp.y,gp.z),this}setFromPoints(e){let t=this.getAttribute(`position`);if(t===void 0){let t=[];for(let n=0,r=e.length;n<r;n++){let r=e[n];t.push(r.x,r.y,r.z||0)}this.setAttribute(`position`,new cp(t,3))}else{let n=Math.min(e.length,t.count);for(let r=0;r<n;r++){let n=e[r];t.setXYZ(r,n.x,n.y,n.z||0)}e.length>t.count&&K(`BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry.`),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new Vf);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)q(`BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.`,this),this.boundingBox.set(new X(-1/0,-1/0,-1/0),new X(1/0,1/0,1/0));else{if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];_p.setFromBufferAttribute(n),this.morphTargetsRelative?(yp.addVectors(this.boundingBox.min,_p.min),this.boundingBox.expandByPoint(yp),yp.addVectors(this.boundingBox.max,_p.max),this.boundingBox.expandByPoint(yp)):(this.boundingBox.expandByPoint(_p.min),this.boundingBox.expandByPoint(_p.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&q(`BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.`,this)}}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new fp);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)q(`BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.`,this),this.boundingSphere.set(new X,1/0);else if(e){let n=this.boundingSphere.center;if(_p.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];vp.setFromBufferAttribute(n),this.morphTargetsRelative?(yp.addVectors(_p.min,vp.min),_p.expandByPoint(yp),yp.addVectors(_p.max,vp.max),_p.expandByPoint(yp)):(_p.expandByPoint(vp.min),_p.expandByPoint(vp.max))}_p.getCenter(n);let r=0;for(let t=0,i=e.count;t<i;t++)yp.fromBufferAttribute(e,t),r=Math.max(r,n.distanceToSquared(yp));if(t)for(let i=0,a=t.length;i<a;i++){let a=t[i],o=this.morphTargetsRelative;for(let t=0,i=a.count;t<i;t++)yp.fromBufferAttribute(a,t),o&&(gp.fromBufferAttribute(e,t),yp.add(gp)),r=Math.max(r,n.distanceToSquared(yp))}this.boundingSphere.radius=Math.sqrt(r),isNaN(this.boundingSphere.radius)&&q(`BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.`,this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){q(`BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)`);return}let n=t.position,r=t.normal,i=t.uv,a=this.getAttribute(`tangent`);(a===void 0||a.count!==n.count)&&(a=new ap(new Float32Array(4*n.count),4),this.setAttribute(`tangent`,a));let o=[],s=[],c=new Uint8Array(n.count);for(let e=0;e<n.count;e++)o[e]=new X,s[e]=new X;let l=new X,u=new X,d=new X,f=new Y,p=new Y,m=new Y,h=new X,g=new X;function _(e,t,r){c[e]=c[t]=c[r]=1,l.fromBufferAttribute(n,e),u.fromBufferAttribute(n,t),d.fromBufferAttribute(n,r),f.fromBufferAttribute(i,e),p.fromBufferAttribute(i,t),m.fromBufferAttribute(i,r),u.sub(l),d.sub(l),p.sub(f),m.sub(f);let a=1/(p.x*m.y-m.x*p.y);isFinite(a)&&(h.copy(u).multiplyScalar(m.y).addScaledVector(d,-p.y).multiplyScalar(a),g.copy(d).multiplyScalar(p.x).addScaledVector(u,-m.x).multiplyScalar(a),o[e].add(h),o[t].add(h),o[r].add(h),s[e].add(g),s[t].add(g),s[r].add(g))}let v=this.groups;v.length===0&&(v=[{start:0,count:e.count}]);for(let t=0,n=v.length;t<n;++t){let n=v[t],r=n.start,i=n.count;for(let t=r,n=r+i;t<n;t+=3)_(e.getX(t+0),e.getX(t+1),e.getX(t+2))}let y=new X,b=new X,x=new X,S=new X;function C(e){x.fromBufferAttribute(r,e),S.copy(x);let t=o[e];y.copy(t),y.sub(x.multiplyScalar(x.dot(t))).normalize(),b.crossVectors(S,t);let n=b.dot(s[e])<0?-1:1;a.setXYZW(e,y.x,y.y,y.z,n)}for(let e=0,t=n.count;e<t;++e)c[e]&&C(e);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute(`position`);if(t!==void 0){let n=this.getAttribute(`normal`);if(n===void 0||n.count!==t.count)n=new ap(new Float32Array(t.count*3),3),this.setAttribute(`normal`,n);else for(let e=0,t=n.count;e<t;e++)n.setXYZ(e,0,0,0);let r=new X,i=new X,a=new X,o=new X,s=new X,c=new X,l=new X,u=new X;if(e)for(let d=0,f=e.count;d<f;d+=3){let f=e.getX(d+0),p=e.getX(d+1),m=e.getX(d+2);r.fromBufferAttribute(t,f),i.fromBufferAttribute(t,p),a.fromBufferAttribute(t,m),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),o.fromBufferAttribute(n,f),s.fromBufferAttribute(n,p),c.fromBufferAttribute(n,m),o.add(l),s.add(l),c.add(l),n.setXYZ(f,o.x,o.y,o.z),n.setXYZ(p,s.x,s.y,s.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let e=0,o=t.count;e<o;e+=3)r.fromBufferAttribute(t,e+0),i.fromBufferAttribute(t,e+1),a.fromBufferAttribute(t,e+2),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),n.setXYZ(e+0,l.x,l.y,l.z),n.setXYZ(e+1,l.x,l.y,l.z),n.setXYZ(e+2,l.x,l.y,l.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)yp.fromBufferAttribute(e,t),yp.normalize(),e.setXYZ(t,yp.x,yp.y,yp.z)}toNonIndexed(){function t(e,t){let n=e.array,r=e.itemSize,i=e.normalized,a=new n.constructor(t.length*r),o=0,s=0;for(let i=0,c=t.length;i<c;i++){o=e.isInterleavedBufferAttribute?t[i]*e.data.stride+e.offset:t[i]*r;for(let e=0;e<r;e++)a[s++]=n[o++]}return new ap(a,r,i)}if(this.index===null)return K(`BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed.`),this;let n=new e,r=this.index.array,i=this.attributes;for(let e in i){let a=i[e],o=t(a,r);n.setAttribute(e,o)}let a=this.morphAttributes;for(let e in a){let i=[],o=a[e];for(let e=0,n=o.length;e<n;e++){let n=o[e],a=t(n,r);i.push(a)}n.morphAttributes[e]=i}n.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let e=0,t=o.length;e<t;e++){let t=o[e];n.addGroup(t.start,t.count,t.materialIndex)}return n}toJSON(){let e={metadata:{version:4.7,type:`BufferGeometry`,generator:`BufferGeometry.toJSON`}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?`BufferGeometry`:this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let t=this.parameters;for(let n in t)t[n]!==void 0&&(e[n]=t[n]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let t in n){let r=n[t];e.data.attributes[t]=r.toJSON(e.data)}let r={},i=!1;for(let t in this.morphAttributes){let n=this.morphAttributes[t],a=[];for(let t=0,r=n.length;t<r;t++){let r=n[t];a.push(r.toJSON(e.data))}a.length>0&&(r[t]=a,i=!0)}i&&(e.data.morphAttributes=r,e.data.morphTargetsRelative=this.morphTargetsRelative);let a=this.groups;a.length>0&&(e.data.groups=JSON.parse(JSON.stringify(a)));let o=this.boundingSphere;return o!==null&&(e.data.boundingSphere=o.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let r=e.attributes;for(let e in r){let n=r[e];this.setAttribute(e,n.clone(t))}let i=e.morphAttributes;for(let e in i){let n=[],r=i[e];for(let e=0,i=r.length;e<i;e++)n.push(r[e].clone(t));this.morphAttributes[e]=n}this.morphTargetsRelative=e.morphTargetsRelative;let a=e.groups;for(let e=0,t=a.length;e<t;e++){let t=a[e];this.addGroup(t.start,t.count,t.materialIndex)}let o=e.boundingBox;o!==null&&(this.boundingBox=o.clone());let s=e.boundingSphere;return s!==null&&(this.boundingSphere=s.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:`dispose`})}},xp=new X,Sp=new X,Cp=new Z,wp=class{constructor(e=new X(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,r){return this.normal.set(e,t,n),this.constant=r,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let r=xp.subVectors(n,t).cross(Sp.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(r,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let r=e.delta(xp),i=this.normal.dot(r);if(i===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let a=-(e.start.dot(this.normal)+this.constant)/i;return n===!0&&(a<0||a>1)?null:t.copy(e.start).addScaledVector(r,a)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||Cp.getNormalMatrix(e),r=this.coplanarPoint(xp).applyMatrix4(e),i=this.normal.applyMatrix3(n).normalize();return this.constant=-r.dot(i),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},Tp=0,Ep=class extends Gu{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:Tp++}),this.uuid=Xu(),this.name=``,this.type=`Material`,this.blending=1,this.side=0,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=204,this.blendDst=205,this.blendEquation=100,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new wf(0,0,0),this.blendAlpha=0,this.depthFunc=3,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=519,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=ju,this.stencilZFail=ju,this.stencilZPass=ju,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){K(`Material: parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?K(`Material: '${t}' is not a property of THREE.${this.type}.`):r&&r.isColor?r.set(n):r&&r.isVector2&&n&&n.isVector2||r&&r.isEuler&&n&&n.isEuler||r&&r.isVector3&&n&&n.isVector3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:`Material`,generator:`Material.toJSON`}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(e=>e.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function r(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}if(t){let t=r(e.textures),i=r(e.images);t.length>0&&(n.textures=t),i.length>0&&(n.images=i)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new wf().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(e=>new wp().fromJSON(e))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(this.vertexColors=typeof e.vertexColors==`number`?e.vertexColors>0:e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let t=e.normalScale;Array.isArray(t)===!1&&(t=[t,t]),this.normalScale=new Y().fromArray(t)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new Y().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let e=t.length;n=Array(e);for(let r=0;r!==e;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:`dispose`})}set needsUpdate(e){e===!0&&this.version++}},Dp=new X,Op=new X,kp=new X,Ap=new X,jp=class{constructor(e=new X,t=new X(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,Dp)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=Dp.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(Dp.copy(this.origin).addScaledVector(this.direction,t),Dp.distanceToSquared(e))}distanceSqToSegment(e,t,n,r){Op.copy(e).add(t).multiplyScalar(.5),kp.copy(t).sub(e).normalize(),Ap.copy(this.origin).sub(Op);let i=e.distanceTo(t)*.5,a=-this.direction.dot(kp),o=Ap.dot(this.direction),s=-Ap.dot(kp),c=Ap.lengthSq(),l=Math.abs(1-a*a),u,d,f,p;if(l>0){if(u=a*s-o,d=a*o-s,p=i*l,u>=0){if(d>=-p){if(d<=p){let e=1/l;u*=e,d*=e,f=u*(u+a*d+2*o)+d*(a*u+d+2*s)+c}else d=i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d=-i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d<=-p?(u=Math.max(0,-(-a*i+o)),d=u>0?-i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c):d<=p?(u=0,d=Math.min(Math.max(-i,-s),i),f=d*(d+2*s)+c):(u=Math.max(0,-(a*i+o)),d=u>0?i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c)}else d=a>0?-i:i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,u),r&&r.copy(Op).addScaledVector(kp,d),f}intersectSphere(e,t){if(e.radius<0)return null;Dp.subVectors(e.center,this.origin);let n=Dp.dot(this.direction),r=Dp.dot(Dp)-n*n,i=e.radius*e.radius;if(r>i)return null;let a=Math.sqrt(i-r),o=n-a,s=n+a;return s<0?null:o<0?this.at(s,t):this.at(o,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,r,i,a,o,s,c=1/this.direction.x,l=1/this.direction.y,u=1/this.direction.z,d=this.origin;return c>=0?(n=(e.min.x-d.x)*c,r=(e.max.x-d.x)*c):(n=(e.max.x-d.x)*c,r=(e.min.x-d.x)*c),l>=0?(i=(e.min.y-d.y)*l,a=(e.max.y-d.y)*l):(i=(e.max.y-d.y)*l,a=(e.min.y-d.y)*l),n>a||i>r||((i>n||isNaN(n))&&(n=i),(a<r||isNaN(r))&&(r=a),u>=0?(o=(e.min.z-d.z)*u,s=(e.max.z-d.z)*u):(o=(e.max.z-d.z)*u,s=(e.min.z-d.z)*u),n>s||o>r)||((o>n||n!==n)&&(n=o),(s<r||r!==r)&&(r=s),r<0)?null:this.at(n>=0?n:r,t)}intersectsBox(e){return this.intersectBox(e,Dp)!==null}intersectTriangle(e,t,n,r,i){let a=this.origin,o=this.direction,s=o.x,c=o.y,l=o.z,u=e.x-a.x,d=e.y-a.y,f=e.z-a.z,p=t.x-a.x,m=t.y-a.y,h=t.z-a.z,g=n.x-a.x,_=n.y-a.y,v=n.z-a.z,y=Math.abs(s),b=Math.abs(c),x=Math.abs(l),S,C,w,T,E,D,O,k,A,j,ee,M;if(y>=b&&y>=x?(w=s,D=u,A=p,M=g,s>=0?(S=c,C=l,T=d,E=f,O=m,k=h,j=_,ee=v):(S=l,C=c,T=f,E=d,O=h,k=m,j=v,ee=_)):b>=x?(w=c,D=d,A=m,M=_,c>=0?(S=l,C=s,T=f,E=u,O=h,k=p,j=v,ee=g):(S=s,C=l,T=u,E=f,O=p,k=h,j=g,ee=v)):(w=l,D=f,A=h,M=v,l>=0?(S=s,C=c,T=u,E=d,O=p,k=m,j=g,ee=_):(S=c,C=s,T=d,E=u,O=m,k=p,j=_,ee=g)),w===0)return null;let te=S/w,ne=C/w,N=1/w,re=T-te*D,ie=E-ne*D,ae=O-te*A,oe=k-ne*A,se=j-te*M,ce=ee-ne*M,le=se*oe-ce*ae,ue=re*ce-ie*se,de=ae*ie-oe*re;if(r){if(le<0||ue<0||de<0)return null}else if((le<0||ue<0||de<0)&&(le>0||ue>0||de>0))return null;let fe=le+ue+de;if(fe===0)return null;let pe=N*(le*D+ue*A+de*M);return(fe>0?pe<0:pe>0)?null:this.at(pe/fe,i)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Mp=class extends Ep{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type=`MeshBasicMaterial`,this.color=new wf(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Qd,this.combine=0,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},Np=new Hd,Pp=new jp,Fp=new fp,Ip=new X,Lp=new X,Rp=new X,zp=new X,Bp=new X,Vp=new X,Hp=new X,Up=new X,Wp=class extends gf{constructor(e=new bp,t=new Mp){super(),this.isMesh=!0,this.type=`Mesh`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}getVertexPosition(e,t){let n=this.geometry,r=n.attributes.position,i=n.morphAttributes.position,a=n.morphTargetsRelative;t.fromBufferAttribute(r,e);let o=this.morphTargetInfluences;if(i&&o){Vp.set(0,0,0);for(let n=0,r=i.length;n<r;n++){let r=o[n],s=i[n];r!==0&&(Bp.fromBufferAttribute(s,e),a?Vp.addScaledVector(Bp,r):Vp.addScaledVector(Bp.sub(t),r))}t.add(Vp)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.material,i=this.matrixWorld;r!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Fp.copy(n.boundingSphere),Fp.applyMatrix4(i),Pp.copy(e.ray).recast(e.near),Fp.containsPoint(Pp.origin)===!1&&(Pp.intersectSphere(Fp,Ip)===null||Pp.origin.distanceToSquared(Ip)>(e.far-e.near)**2)||(Np.copy(i).invert(),Pp.copy(e.ray).applyMatrix4(Np),(n.boundingBox===null||Pp.intersectsBox(n.boundingBox)!==!1)&&this._computeIntersections(e,t,Pp)))}_computeIntersections(e,t,n){let r,i=this.geometry,a=this.material,o=i.index,s=i.attributes.position,c=i.attributes.uv,l=i.attributes.uv1,u=i.attributes.normal,d=i.groups,f=i.drawRange;if(o!==null){if(Array.isArray(a))for(let i=0,s=d.length;i<s;i++){let s=d[i],p=a[s.materialIndex],m=Math.max(s.start,f.start),h=Math.min(o.count,Math.min(s.start+s.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=o.getX(i),d=o.getX(i+1),f=o.getX(i+2);r=Kp(this,p,e,n,c,l,u,a,d,f),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=s.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),s=Math.min(o.count,f.start+f.count);for(let d=i,f=s;d<f;d+=3){let i=o.getX(d),s=o.getX(d+1),f=o.getX(d+2);r=Kp(this,a,e,n,c,l,u,i,s,f),r&&(r.faceIndex=Math.floor(d/3),t.push(r))}}}else if(s!==void 0){if(Array.isArray(a))for(let i=0,o=d.length;i<o;i++){let o=d[i],p=a[o.materialIndex],m=Math.max(o.start,f.start),h=Math.min(s.count,Math.min(o.start+o.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=i,s=i+1,d=i+2;r=Kp(this,p,e,n,c,l,u,a,s,d),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=o.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),o=Math.min(s.count,f.start+f.count);for(let s=i,d=o;s<d;s+=3){let i=s,o=s+1,d=s+2;r=Kp(this,a,e,n,c,l,u,i,o,d),r&&(r.faceIndex=Math.floor(s/3),t.push(r))}}}}};function Gp(e,t,n,r,i,a,o,s){let c;if(c=t.side===1?r.intersectTriangle(o,a,i,!0,s):r.intersectTriangle(i,a,o,t.side===0,s),c===null)return null;Up.copy(s),Up.applyMatrix4(e.matrixWorld);let l=n.ray.origin.distanceTo(Up);return l<n.near||l>n.far?null:{distance:l,point:Up.clone(),object:e}}function Kp(e,t,n,r,i,a,o,s,c,l){e.getVertexPosition(s,Lp),e.getVertexPosition(c,Rp),e.getVertexPosition(l,zp);let u=Gp(e,t,n,r,Lp,Rp,zp,Hp);if(u){let e=new X;Bf.getBarycoord(Hp,Lp,Rp,zp,e),i&&(u.uv=Bf.getInterpolatedAttribute(i,s,c,l,e,new Y)),a&&(u.uv1=Bf.getInterpolatedAttribute(a,s,c,l,e,new Y)),o&&(u.normal=Bf.getInterpolatedAttribute(o,s,c,l,e,new X),u.normal.dot(r.direction)>0&&u.normal.multiplyScalar(-1));let t={a:s,b:c,c:l,normal:new X,materialIndex:0};Bf.getNormal(Lp,Rp,zp,t.normal),u.face=t,u.barycoord=e}return u}var qp=class extends Id{constructor(e=null,t=1,n=1,r,i,a,o,s,c=cl,l=cl,u,d){super(null,a,o,s,c,l,r,i,u,d),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}},Jp=class extends ap{constructor(e,t,n,r=1){super(e,t,n),this.isInstancedBufferAttribute=!0,this.meshPerAttribute=r}copy(e){return super.copy(e),this.meshPerAttribute=e.meshPerAttribute,this}toJSON(){let e=super.toJSON();return e.meshPerAttribute=this.meshPerAttribute,e.isInstancedBufferAttribute=!0,e}},Yp=new Hd,Xp=new Hd,Zp=[],Qp=new Vf,$p=new Hd,em=new Wp,tm=new fp,nm=class extends Wp{constructor(e,t,n){super(e,t),this.isInstancedMesh=!0,this.instanceMatrix=new Jp(new Float32Array(n*16),16),this.instanceColor=null,this.morphTexture=null,this.count=n,this.boundingBox=null,this.boundingSphere=null;for(let e=0;e<n;e++)this.setMatrixAt(e,$p)}computeBoundingBox(){let e=this.geometry,t=this.count;this.boundingBox===null&&(this.boundingBox=new Vf),e.boundingBox===null&&e.computeBoundingBox(),this.boundingBox.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Yp),Qp.copy(e.boundingBox).applyMatrix4(Yp),this.boundingBox.union(Qp)}computeBoundingSphere(){let e=this.geometry,t=this.count;this.boundingSphere===null&&(this.boundingSphere=new fp),e.boundingSphere===null&&e.computeBoundingSphere(),this.boundingSphere.makeEmpty();for(let n=0;n<t;n++)this.getMatrixAt(n,Yp),tm.copy(e.boundingSphere).applyMatrix4(Yp),this.boundingSphere.union(tm)}copy(e,t){return super.copy(e,t),this.instanceMatrix.copy(e.instanceMatrix),this.morphTexture=e.morphTexture===null?null:e.morphTexture.clone(),this.instanceColor=e.instanceColor===null?null:e.instanceColor.clone(),this.count=e.count,this.boundingBox=e.boundingBox===null?null:e.boundingBox.clone(),this.boundingSphere=e.boundingSphere===null?null:e.boundingSphere.clone(),this}getColorAt(e,t){return this.instanceColor===null?t.setRGB(1,1,1):t.fromArray(this.instanceColor.array,e*3)}getMatrixAt(e,t){return t.fromArray(this.instanceMatrix.array,e*16)}getMorphAt(e,t){let n=t.morphTargetInfluences,r=this.morphTexture.source.data.data,i=e*(n.length+1)+1;for(let e=0;e<n.length;e++)n[e]=r[i+e]}raycast(e,t){let n=this.matrixWorld,r=this.count;if(em.geometry=this.geometry,em.material=this.material,em.material!==void 0&&(this.boundingSphere===null&&this.computeBoundingSphere(),tm.copy(this.boundingSphere),tm.applyMatrix4(n),e.ray.intersectsSphere(tm)!==!1))for(let i=0;i<r;i++){this.getMatrixAt(i,Yp),Xp.multiplyMatrices(n,Yp),em.matrixWorld=Xp,em.raycast(e,Zp);for(let e=0,n=Zp.length;e<n;e++){let n=Zp[e];n.instanceId=i,n.object=this,t.push(n)}Zp.length=0}}setColorAt(e,t){return this.instanceColor===null&&(this.instanceColor=new Jp(new Float32Array(this.instanceMatrix.count*3).fill(1),3)),t.toArray(this.instanceColor.array,e*3),this}setMatrixAt(e,t){return t.toArray(this.instanceMatrix.array,e*16),this}setMorphAt(e,t){let n=t.morphTargetInfluences,r=n.length+1;this.morphTexture===null&&(this.morphTexture=new qp(new Float32Array(r*this.count),r,this.count,Ml,bl));let i=this.morphTexture.source.data.data,a=0;for(let e=0;e<n.length;e++)a+=n[e];let o=this.geometry.morphTargetsRelative?1:1-a,s=r*e;return i[s]=o,i.set(n,s+1),this}updateMorphTargets(){}dispose(){super.dispose(),this.instanceMatrix.dispose(),this.instanceColor!==null&&this.instanceColor.dispose(),this.morphTexture!==null&&(this.morphTexture.dispose(),this.morphTexture=null)}},rm=new fp,im=new Y(.5,.5),am=new X,om=class{constructor(e=new wp,t=new wp,n=new wp,r=new wp,i=new wp,a=new wp){this.planes=[e,t,n,r,i,a]}set(e,t,n,r,i,a){let o=this.planes;return o[0].copy(e),o[1].copy(t),o[2].copy(n),o[3].copy(r),o[4].copy(i),o[5].copy(a),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=Pu,n=!1){let r=this.planes,i=e.elements,a=i[0],o=i[1],s=i[2],c=i[3],l=i[4],u=i[5],d=i[6],f=i[7],p=i[8],m=i[9],h=i[10],g=i[11],_=i[12],v=i[13],y=i[14],b=i[15];if(r[0].setComponents(c-a,f-l,g-p,b-_).normalize(),r[1].setComponents(c+a,f+l,g+p,b+_).normalize(),r[2].setComponents(c+o,f+u,g+m,b+v).normalize(),r[3].setComponents(c-o,f-u,g-m,b-v).normalize(),n)r[4].setComponents(s,d,h,y).normalize(),r[5].setComponents(c-s,f-d,g-h,b-y).normalize();else if(r[4].setComponents(c-s,f-d,g-h,b-y).normalize(),t===2e3)r[5].setComponents(c+s,f+d,g+h,b+y).normalize();else if(t===2001)r[5].setComponents(s,d,h,y).normalize();else throw Error(`THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: `+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),rm.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),rm.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(rm)}intersectsSprite(e){return rm.center.set(0,0,0),rm.radius=.7071067811865476+im.distanceTo(e.center),rm.applyMatrix4(e.matrixWorld),this.intersectsSphere(rm)}intersectsSphere(e){let t=this.planes,n=e.center,r=-e.radius;for(let e=0;e<6;e++)if(t[e].distanceToPoint(n)<r)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let r=t[n];if(am.x=r.normal.x>0?e.max.x:e.min.x,am.y=r.normal.y>0?e.max.y:e.min.y,am.z=r.normal.z>0?e.max.z:e.min.z,r.distanceToPoint(am)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},sm=new Hd,cm=class e{constructor(){this.coordinateSystem=Pu,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let e=0;e<t.length;e++){let r=t[e];sm.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[e]===void 0&&(n[e]=new om),n[e].setFromProjectionMatrix(sm,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let r=0;r<e._count;r++)t[r]===void 0&&(t[r]=new om),t[r].copy(n[r]);return this._count=e._count,this}clone(){return new e().copy(this)}},lm=class extends Id{constructor(e=[],t=301,n,r,i,a,o,s,c,l){super(e,t,n,r,i,a,o,s,c,l),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}},um=class extends Id{constructor(e,t,n=yl,r,i,a,o=cl,s=cl,c,l=Al,u=1){if(l!==1026&&l!==1027)throw Error(`THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat`);super({width:e,height:t,depth:u},r,i,a,o,s,l,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new Md(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},dm=class extends um{constructor(e,t=yl,n=301,r,i,a=cl,o=cl,s,c=Al){let l={width:e,height:e,depth:1},u=[l,l,l,l,l,l];super(e,e,t,n,r,i,a,o,s,c),this.image=u,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},fm=class extends Id{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},pm=class e extends bp{constructor(e=1,t=1,n=1,r=1,i=1,a=1){super(),this.type=`BoxGeometry`,this.parameters={width:e,height:t,depth:n,widthSegments:r,heightSegments:i,depthSegments:a};let o=this;r=Math.floor(r),i=Math.floor(i),a=Math.floor(a);let s=[],c=[],l=[],u=[],d=0,f=0;p(`z`,`y`,`x`,-1,-1,n,t,e,a,i,0),p(`z`,`y`,`x`,1,-1,n,t,-e,a,i,1),p(`x`,`z`,`y`,1,1,e,n,t,r,a,2),p(`x`,`z`,`y`,1,-1,e,n,-t,r,a,3),p(`x`,`y`,`z`,1,-1,e,t,n,r,i,4),p(`x`,`y`,`z`,-1,-1,e,t,-n,r,i,5),this.setIndex(s),this.setAttribute(`position`,new cp(c,3)),this.setAttribute(`normal`,new cp(l,3)),this.setAttribute(`uv`,new cp(u,2));function p(e,t,n,r,i,a,p,m,h,g,_){let v=a/h,y=p/g,b=a/2,x=p/2,S=m/2,C=h+1,w=g+1,T=0,E=0,D=new X;for(let a=0;a<w;a++){let o=a*y-x;for(let s=0;s<C;s++)D[e]=(s*v-b)*r,D[t]=o*i,D[n]=S,c.push(D.x,D.y,D.z),D[e]=0,D[t]=0,D[n]=m>0?1:-1,l.push(D.x,D.y,D.z),u.push(s/h),u.push(1-a/g),T+=1}for(let e=0;e<g;e++)for(let t=0;t<h;t++){let n=d+t+C*e,r=d+t+C*(e+1),i=d+(t+1)+C*(e+1),a=d+(t+1)+C*e;s.push(n,r,a),s.push(r,i,a),E+=6}o.addGroup(f,E,_),f+=E,d+=T}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}},mm=class e extends bp{constructor(e=1,t=1,n=1,r=32,i=1,a=!1,o=0,s=Math.PI*2){super(),this.type=`CylinderGeometry`,this.parameters={radiusTop:e,radiusBottom:t,height:n,radialSegments:r,heightSegments:i,openEnded:a,thetaStart:o,thetaLength:s};let c=this;r=Math.floor(r),i=Math.floor(i);let l=[],u=[],d=[],f=[],p=0,m=[],h=n/2,g=0;_(),a===!1&&(e>0&&v(!0),t>0&&v(!1)),this.setIndex(l),this.setAttribute(`position`,new cp(u,3)),this.setAttribute(`normal`,new cp(d,3)),this.setAttribute(`uv`,new cp(f,2));function _(){let a=new X,_=new X,v=0,y=(t-e)/n;for(let c=0;c<=i;c++){let l=[],g=c/i,v=g*(t-e)+e;for(let e=0;e<=r;e++){let t=e/r,i=t*s+o,c=Math.sin(i),m=Math.cos(i);_.x=v*c,_.y=-g*n+h,_.z=v*m,u.push(_.x,_.y,_.z),a.set(c,y,m).normalize(),d.push(a.x,a.y,a.z),f.push(t,1-g),l.push(p++)}m.push(l)}for(let n=0;n<r;n++)for(let r=0;r<i;r++){let a=m[r][n],o=m[r+1][n],s=m[r+1][n+1],c=m[r][n+1];(e>0||r!==0)&&(l.push(a,o,c),v+=3),(t>0||r!==i-1)&&(l.push(o,s,c),v+=3)}c.addGroup(g,v,0),g+=v}function v(n){let i=p,a=new Y,m=new X,_=0,v=n===!0?e:t,y=n===!0?1:-1;for(let e=1;e<=r;e++)u.push(0,h*y,0),d.push(0,y,0),f.push(.5,.5),p++;let b=p;for(let e=0;e<=r;e++){let t=e/r*s+o,n=Math.cos(t),i=Math.sin(t);m.x=v*i,m.y=h*y,m.z=v*n,u.push(m.x,m.y,m.z),d.push(0,y,0),a.x=n*.5+.5,a.y=i*.5*y+.5,f.push(a.x,a.y),p++}for(let e=0;e<r;e++){let t=i+e,r=b+e;n===!0?l.push(r,r+1,t):l.push(r+1,r,t),_+=3}c.addGroup(g,_,n===!0?1:2),g+=_}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.radiusTop,t.radiusBottom,t.height,t.radialSegments,t.heightSegments,t.openEnded,t.thetaStart,t.thetaLength)}},hm=class e extends bp{constructor(e=1,t=1,n=1,r=1){super(),this.type=`PlaneGeometry`,this.parameters={width:e,height:t,widthSegments:n,heightSegments:r};let i=e/2,a=t/2,o=Math.floor(n),s=Math.floor(r),c=o+1,l=s+1,u=e/o,d=t/s,f=[],p=[],m=[],h=[];for(let e=0;e<l;e++){let t=e*d-a;for(let n=0;n<c;n++){let r=n*u-i;p.push(r,-t,0),m.push(0,0,1),h.push(n/o),h.push(1-e/s)}}for(let e=0;e<s;e++)for(let t=0;t<o;t++){let n=t+c*e,r=t+c*(e+1),i=t+1+c*(e+1),a=t+1+c*e;f.push(n,r,a),f.push(r,i,a)}this.setIndex(f),this.setAttribute(`position`,new cp(p,3)),this.setAttribute(`normal`,new cp(m,3)),this.setAttribute(`uv`,new cp(h,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.widthSegments,t.heightSegments)}},gm=class e extends bp{constructor(e=1,t=32,n=16,r=0,i=Math.PI*2,a=0,o=Math.PI){super(),this.type=`SphereGeometry`,this.parameters={radius:e,widthSegments:t,heightSegments:n,phiStart:r,phiLength:i,thetaStart:a,thetaLength:o},t=Math.max(3,Math.floor(t)),n=Math.max(2,Math.floor(n));let s=Math.min(a+o,Math.PI),c=0,l=[],u=new X,d=new X,f=[],p=[],m=[],h=[];for(let f=0;f<=n;f++){let g=[],_=f/n,v=a+_*o,y=e*Math.cos(v),b=Math.sqrt(e*e-y*y),x=0;f===0&&a===0?x=.5/t:f===n&&s===Math.PI&&(x=-.5/t);for(let e=0;e<=t;e++){let n=e/t,a=r+n*i;u.x=-b*Math.cos(a),u.y=y,u.z=b*Math.sin(a),p.push(u.x,u.y,u.z),d.copy(u).normalize(),m.push(d.x,d.y,d.z),h.push(n+x,1-_),g.push(c++)}l.push(g)}for(let e=0;e<n;e++)for(let r=0;r<t;r++){let t=l[e][r+1],i=l[e][r],o=l[e+1][r],c=l[e+1][r+1];(e!==0||a>0)&&f.push(t,i,c),(e!==n-1||s<Math.PI)&&f.push(i,o,c)}this.setIndex(f),this.setAttribute(`position`,new cp(p,3)),this.setAttribute(`normal`,new cp(m,3)),this.setAttribute(`uv`,new cp(h,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.radius,t.widthSegments,t.heightSegments,t.phiStart,t.phiLength,t.thetaStart,t.thetaLength)}};function _m(e){let t={};for(let n in e){t[n]={};for(let r in e[n]){let i=e[n][r];if(ym(i))i.isRenderTargetTexture?(K(`UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms().`),t[n][r]=null):t[n][r]=i.clone();else if(Array.isArray(i)){if(ym(i[0])){let e=[];for(let t=0,n=i.length;t<n;t++)e[t]=i[t].clone();t[n][r]=e}else t[n][r]=i.slice()}else t[n][r]=i}}return t}function vm(e){let t={};for(let n=0;n<e.length;n++){let r=_m(e[n]);for(let e in r)t[e]=r[e]}return t}function ym(e){return e&&(e.isColor||e.isMatrix3||e.isMatrix4||e.isVector2||e.isVector3||e.isVector4||e.isTexture||e.isQuaternion)}function bm(e){let t=[];for(let n=0;n<e.length;n++)t.push(e[n].clone());return t}function xm(e){let t=e.getRenderTarget();return t===null?e.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:Ed.workingColorSpace}var Sm={clone:_m,merge:vm},Cm=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,wm=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Tm=class extends Ep{constructor(e){super(),this.isShaderMaterial=!0,this.type=`ShaderMaterial`,this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Cm,this.fragmentShader=wm,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=_m(e.uniforms),this.uniformsGroups=bm(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let n in this.uniforms){let r=this.uniforms[n].value;r&&r.isTexture?t.uniforms[n]={type:`t`,value:r.toJSON(e).uuid}:r&&r.isColor?t.uniforms[n]={type:`c`,value:r.getHex()}:r&&r.isVector2?t.uniforms[n]={type:`v2`,value:r.toArray()}:r&&r.isVector3?t.uniforms[n]={type:`v3`,value:r.toArray()}:r&&r.isVector4?t.uniforms[n]={type:`v4`,value:r.toArray()}:r&&r.isMatrix3?t.uniforms[n]={type:`m3`,value:r.toArray()}:r&&r.isMatrix4?t.uniforms[n]={type:`m4`,value:r.toArray()}:t.uniforms[n]={value:r}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let e in this.extensions)this.extensions[e]===!0&&(n[e]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let r=e.uniforms[n];switch(this.uniforms[n]={},r.type){case`t`:this.uniforms[n].value=t[r.value]||null;break;case`c`:this.uniforms[n].value=new wf().setHex(r.value);break;case`v2`:this.uniforms[n].value=new Y().fromArray(r.value);break;case`v3`:this.uniforms[n].value=new X().fromArray(r.value);break;case`v4`:this.uniforms[n].value=new Ld().fromArray(r.value);break;case`m3`:this.uniforms[n].value=new Z().fromArray(r.value);break;case`m4`:this.uniforms[n].value=new Hd().fromArray(r.value);break;default:this.uniforms[n].value=r.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let t in e.extensions)this.extensions[t]=e.extensions[t];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},Em=class extends Tm{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type=`RawShaderMaterial`}},Dm=class extends Ep{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type=`MeshDepthMaterial`,this.depthPacking=Eu,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},Om=class extends Ep{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type=`MeshDistanceMaterial`,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function km(e,t){return!e||e.constructor===t?e:typeof t.BYTES_PER_ELEMENT==`number`?new t(e):Array.prototype.slice.call(e)}function Am(e){return e!==void 0&&e.inTangents!==void 0&&e.outTangents!==void 0}var jm=class{constructor(e,t,n,r){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=r===void 0?new t.constructor(n):r,this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,r=t[n],i=t[n-1];validate_interval:{seek:{let a;linear_scan:{forward_scan:if(!(e<r)){for(let a=n+2;;){if(r===void 0){if(e<i)break forward_scan;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(i=r,r=t[++n],e<r)break seek}a=t.length;break linear_scan}if(!(e>=i)){let o=t[1];e<o&&(n=2,i=o);for(let a=n-2;;){if(i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===a)break;if(r=i,i=t[--n-1],e>=i)break seek}a=n,n=0;break linear_scan}break validate_interval}for(;n<a;){let r=n+a>>>1;e<t[r]?a=r:n=r+1}if(r=t[n],i=t[n-1],i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(r===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,i,r)}return this.interpolate_(n,i,e,r)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,r=this.valueSize,i=e*r;for(let e=0;e!==r;++e)t[e]=n[i+e];return t}interpolate_(){throw Error(`THREE.Interpolant: Call to abstract method.`)}intervalChanged_(){}},Mm=class extends jm{constructor(e,t,n,r){super(e,t,n,r),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:Cu,endingEnd:Cu}}intervalChanged_(e,t,n){let r=this.parameterPositions,i=e-2,a=e+1,o=r[i],s=r[a];if(o===void 0)switch(this.getSettings_().endingStart){case wu:i=e,o=2*t-n;break;case Tu:i=r.length-2,o=t+r[i]-r[i+1];break;default:i=e,o=n}if(s===void 0)switch(this.getSettings_().endingEnd){case wu:a=e,s=2*n-t;break;case Tu:a=1,s=n+r[1]-r[0];break;default:a=e-1,s=t}let c=(n-t)*.5,l=this.valueSize;this._weightPrev=c/(t-o),this._weightNext=c/(s-n),this._offsetPrev=i*l,this._offsetNext=a*l}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this._offsetPrev,u=this._offsetNext,d=this._weightPrev,f=this._weightNext,p=(n-t)/(r-t),m=p*p,h=m*p,g=-d*h+2*d*m-d*p,_=(1+d)*h+(-1.5-2*d)*m+(-.5+d)*p+1,v=(-1-f)*h+(1.5+f)*m+.5*p,y=f*h-f*m;for(let e=0;e!==o;++e)i[e]=g*a[l+e]+_*a[c+e]+v*a[s+e]+y*a[u+e];return i}},Nm=class extends jm{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=(n-t)/(r-t),u=1-l;for(let e=0;e!==o;++e)i[e]=a[c+e]*u+a[s+e]*l;return i}},Pm=class extends jm{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e){return this.copySampleValue_(e-1)}},Fm=class extends jm{interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this.inTangents,u=this.outTangents;if(!l||!u){let e=(n-t)/(r-t),l=1-e;for(let t=0;t!==o;++t)i[t]=a[c+t]*l+a[s+t]*e;return i}let d=o*2,f=e-1;for(let p=0;p!==o;++p){let o=a[c+p],m=a[s+p],h=f*d+p*2,g=u[h],_=u[h+1],v=e*d+p*2,y=l[v],b=l[v+1],x=Rm(n,t,g,y,r);i[p]=Im(x,o,_,b,m)}return i}};function Im(e,t,n,r,i){let a=1-e;return a*a*a*t+3*a*a*e*n+3*a*e*e*r+e*e*e*i}function Lm(e,t,n,r,i){let a=1-e;return 3*a*a*(n-t)+6*a*e*(r-n)+3*e*e*(i-r)}function Rm(e,t,n,r,i){let a=(e-t)/(i-t);for(let o=0;o<8;o++){let o=Im(a,t,n,r,i)-e;if(Math.abs(o)<1e-10)break;let s=Lm(a,t,n,r,i);if(Math.abs(s)<1e-10)break;a=Math.max(0,Math.min(1,a-o/s))}return a}var zm=class{constructor(e,t,n,r){if(e===void 0)throw Error(`THREE.KeyframeTrack: track name is undefined`);if(t===void 0||t.length===0)throw Error(`THREE.KeyframeTrack: no keyframes in track named `+e);this.name=e,this.times=km(t,this.TimeBufferType),this.values=km(n,this.ValueBufferType),this.setInterpolation(r||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:km(e.times,Array),values:km(e.values,Array)};let t=e.getInterpolation();t!==e.DefaultInterpolation&&(n.interpolation=t),Am(e.settings)&&(n.settings={inTangents:km(e.settings.inTangents,Array),outTangents:km(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new Pm(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new Nm(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new Mm(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new Fm(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case yu:t=this.InterpolantFactoryMethodDiscrete;break;case bu:t=this.InterpolantFactoryMethodLinear;break;case xu:t=this.InterpolantFactoryMethodSmooth;break;case Su:t=this.InterpolantFactoryMethodBezier}if(t===void 0){let t=`unsupported interpolation for `+this.ValueTypeName+` keyframe track named `+this.name;if(this.createInterpolant===void 0){if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw Error(t)}return K(`KeyframeTrack:`,t),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return yu;case this.InterpolantFactoryMethodLinear:return bu;case this.InterpolantFactoryMethodSmooth:return xu;case this.InterpolantFactoryMethodBezier:return Su}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]+=e;Am(this.settings)&&(Bm(this.settings.inTangents,e),Bm(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]*=e;Am(this.settings)&&(Vm(this.settings.inTangents,e),Vm(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,r=n.length,i=0,a=r-1;for(;i!==r&&n[i]<e;)++i;for(;a!==-1&&n[a]>t;)--a;if(++a,i!==0||a!==r){i>=a&&(a=Math.max(a,1),i=a-1);let e=this.getValueSize();this.times=n.slice(i,a),this.values=this.values.slice(i*e,a*e)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(q(`KeyframeTrack: Invalid value size in track.`,this),e=!1);let n=this.times,r=this.values,i=n.length;i===0&&(q(`KeyframeTrack: Track is empty.`,this),e=!1);let a=null;for(let t=0;t!==i;t++){let r=n[t];if(typeof r==`number`&&isNaN(r)){q(`KeyframeTrack: Time is not a valid number.`,this,t,r),e=!1;break}if(a!==null&&a>r){q(`KeyframeTrack: Out of order keys.`,this,t,r,a),e=!1;break}a=r}if(r!==void 0&&Iu(r))for(let t=0,n=r.length;t!==n;++t){let n=r[t];if(isNaN(n)){q(`KeyframeTrack: Value is not a valid number.`,this,t,n),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),r=this.getInterpolation()===xu,i=e.length-1,a=1;for(let o=1;o<i;++o){let i=!1,s=e[o];if(s!==e[o+1]&&(o!==1||s!==e[0])){if(r)i=!0;else{let e=o*n,r=e-n,a=e+n;for(let o=0;o!==n;++o){let n=t[e+o];if(n!==t[r+o]||n!==t[a+o]){i=!0;break}}}}if(i){if(o!==a){e[a]=e[o];let r=o*n,i=a*n;for(let e=0;e!==n;++e)t[i+e]=t[r+e]}++a}}if(i>0){e[a]=e[i];for(let e=i*n,r=a*n,o=0;o!==n;++o)t[r+o]=t[e+o];++a}return a===e.length?(this.times=e,this.values=t):(this.times=e.slice(0,a),this.values=t.slice(0,a*n)),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,r=new n(this.name,e,t);return r.createInterpolant=this.createInterpolant,Am(this.settings)&&(r.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),r}};function Bm(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]+=t}function Vm(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]*=t}zm.prototype.ValueTypeName=``,zm.prototype.TimeBufferType=Float32Array,zm.prototype.ValueBufferType=Float32Array,zm.prototype.DefaultInterpolation=bu;var Hm=class extends zm{constructor(e,t,n){super(e,t,n)}};Hm.prototype.ValueTypeName=`bool`,Hm.prototype.ValueBufferType=Array,Hm.prototype.DefaultInterpolation=yu,Hm.prototype.InterpolantFactoryMethodLinear=void 0,Hm.prototype.InterpolantFactoryMethodSmooth=void 0;var Um=class extends zm{constructor(e,t,n,r){super(e,t,n,r)}};Um.prototype.ValueTypeName=`color`;var Wm=class extends zm{constructor(e,t,n,r){super(e,t,n,r)}};Wm.prototype.ValueTypeName=`number`;var Gm=class extends jm{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=(n-t)/(r-t),c=e*o;for(let e=c+o;c!==e;c+=4)yd.slerpFlat(i,0,a,c-o,a,c,s);return i}},Km=class extends zm{constructor(e,t,n,r){super(e,t,n,r)}InterpolantFactoryMethodLinear(e){return new Gm(this.times,this.values,this.getValueSize(),e)}};Km.prototype.ValueTypeName=`quaternion`,Km.prototype.InterpolantFactoryMethodSmooth=void 0;var qm=class extends zm{constructor(e,t,n){super(e,t,n)}};qm.prototype.ValueTypeName=`string`,qm.prototype.ValueBufferType=Array,qm.prototype.DefaultInterpolation=yu,qm.prototype.InterpolantFactoryMethodLinear=void 0,qm.prototype.InterpolantFactoryMethodSmooth=void 0;var Jm=class extends zm{constructor(e,t,n,r){super(e,t,n,r)}};Jm.prototype.ValueTypeName=`vector`;var Ym=new X,Xm=new yd,Zm=new X,Qm=class extends gf{constructor(){super(),this.isCamera=!0,this.type=`Camera`,this.matrixWorldInverse=new Hd,this.projectionMatrix=new Hd,this.projectionMatrixInverse=new Hd,this.coordinateSystem=Pu,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Ym,Xm,Zm),Zm.x===1&&Zm.y===1&&Zm.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Ym,Xm,Zm.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(Ym,Xm,Zm),Zm.x===1&&Zm.y===1&&Zm.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Ym,Xm,Zm.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},$m=new X,eh=new Y,th=new Y,nh=class extends Qm{constructor(e=50,t=1,n=.1,r=2e3){super(),this.isPerspectiveCamera=!0,this.type=`PerspectiveCamera`,this.fov=e,this.zoom=1,this.near=n,this.far=r,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=Yu*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(Ju*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return Yu*2*Math.atan(Math.tan(Ju*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){$m.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set($m.x,$m.y).multiplyScalar(-e/$m.z),$m.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set($m.x,$m.y).multiplyScalar(-e/$m.z)}getViewSize(e,t){return this.getViewBounds(e,eh,th),t.subVectors(th,eh)}setViewOffset(e,t,n,r,i,a){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(Ju*.5*this.fov)/this.zoom,n=2*t,r=this.aspect*n,i=-.5*r,a=this.view;if(this.view!==null&&this.view.enabled){let e=a.fullWidth,o=a.fullHeight;i+=a.offsetX*r/e,t-=a.offsetY*n/o,r*=a.width/e,n*=a.height/o}let o=this.filmOffset;o!==0&&(i+=e*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(i,i+r,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}},rh=class extends Qm{constructor(e=-1,t=1,n=1,r=-1,i=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type=`OrthographicCamera`,this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=r,this.near=i,this.far=a,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,r,i,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,r=(this.top+this.bottom)/2,i=n-e,a=n+e,o=r+t,s=r-t;if(this.view!==null&&this.view.enabled){let e=(this.right-this.left)/this.view.fullWidth/this.zoom,t=(this.top-this.bottom)/this.view.fullHeight/this.zoom;i+=e*this.view.offsetX,a=i+e*this.view.width,o-=t*this.view.offsetY,s=o-t*this.view.height}this.projectionMatrix.makeOrthographic(i,a,o,s,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},ih=-90,ah=1,oh=class extends gf{constructor(e,t,n){super(),this.type=`CubeCamera`,this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let r=new nh(ih,ah,e,t);r.layers=this.layers,this.add(r);let i=new nh(ih,ah,e,t);i.layers=this.layers,this.add(i);let a=new nh(ih,ah,e,t);a.layers=this.layers,this.add(a);let o=new nh(ih,ah,e,t);o.layers=this.layers,this.add(o);let s=new nh(ih,ah,e,t);s.layers=this.layers,this.add(s);let c=new nh(ih,ah,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,r,i,a,o,s]=t;for(let e of t)this.remove(e);if(e===2e3)n.up.set(0,1,0),n.lookAt(1,0,0),r.up.set(0,1,0),r.lookAt(-1,0,0),i.up.set(0,0,-1),i.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),s.up.set(0,1,0),s.lookAt(0,0,-1);else if(e===2001)n.up.set(0,-1,0),n.lookAt(-1,0,0),r.up.set(0,-1,0),r.lookAt(1,0,0),i.up.set(0,0,1),i.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),s.up.set(0,-1,0),s.lookAt(0,0,-1);else throw Error(`THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: `+e);for(let e of t)this.add(e),e.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:r}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[i,a,o,s,c,l]=this.children,u=e.getRenderTarget(),d=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),p=e.xr.enabled;e.xr.enabled=!1;let m=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let h=!1;h=e.isWebGLRenderer===!0?e.state.buffers.depth.getReversed():e.reversedDepthBuffer,e.setRenderTarget(n,0,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,i),e.setRenderTarget(n,1,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,2,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,3,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,s),e.setRenderTarget(n,4,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=m,e.setRenderTarget(n,5,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(u,d,f),e.xr.enabled=p,n.texture.needsPMREMUpdate=!0}},sh=class extends nh{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}},ch=`\\[\\]\\.:\\/`,lh=RegExp(`[\\[\\]\\.:\\/]`,`g`),uh=`[^\\[\\]\\.:\\/]`,dh=`[^`+ch.replace(`\\.`,``)+`]`,fh=`((?:WC+[\\/:])*)`.replace(`WC`,uh),ph=`(WCOD+)?`.replace(`WCOD`,dh),mh=`(?:\\.(WC+)(?:\\[(.+)\\])?)?`.replace(`WC`,uh),hh=`\\.(WC+)(?:\\[(.+)\\])?`.replace(`WC`,uh),gh=RegExp(`^`+fh+ph+mh+hh+`$`),_h=[`material`,`materials`,`bones`,`map`],vh=class{constructor(e,t,n){let r=n||yh.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,r)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,r=this._bindings[n];r!==void 0&&r.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let r=this._targetGroup.nCachedObjects_,i=n.length;r!==i;++r)n[r].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},yh=class e{constructor(t,n,r){this.path=n,this.parsedPath=r||e.parseTrackName(n),this.node=e.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,n,r){return t&&t.isAnimationObjectGroup?new e.Composite(t,n,r):new e(t,n,r)}static sanitizeNodeName(e){return e.replace(/\s/g,`_`).replace(lh,``)}static parseTrackName(e){let t=gh.exec(e);if(t===null)throw Error(`THREE.PropertyBinding: Cannot parse trackName: `+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},r=n.nodeName&&n.nodeName.lastIndexOf(`.`);if(r!==void 0&&r!==-1){let e=n.nodeName.substring(r+1);_h.indexOf(e)!==-1&&(n.nodeName=n.nodeName.substring(0,r),n.objectName=e)}if(n.propertyName===null||n.propertyName.length===0)throw Error(`THREE.PropertyBinding: can not parse propertyName from trackName: `+e);return n}static findNode(e,t){if(t===void 0||t===``||t===`.`||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(e){for(let r=0;r<e.length;r++){let i=e[r];if(i.name===t||i.uuid===t)return i;let a=n(i.children);if(a)return a}return null},r=n(e.children);if(r)return r}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)e[t++]=n[r]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let t=this.node,n=this.parsedPath,r=n.objectName,i=n.propertyName,a=n.propertyIndex;if(t||(t=e.findNode(this.rootNode,n.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){K(`PropertyBinding: No target node found for track: `+this.path+`.`);return}if(r){let e=n.objectIndex;switch(r){case`materials`:if(!t.material){q(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.materials){q(`PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.`,this);return}t=t.material.materials;break;case`bones`:if(!t.skeleton){q(`PropertyBinding: Can not bind to bones as node does not have a skeleton.`,this);return}t=t.skeleton.bones;for(let n=0;n<t.length;n++)if(t[n].name===e){e=n;break}break;case`map`:if(`map`in t){t=t.map;break}if(!t.material){q(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.map){q(`PropertyBinding: Can not bind to material.map as node.material does not have a map.`,this);return}t=t.material.map;break;default:if(t[r]===void 0){q(`PropertyBinding: Can not bind to objectName of node undefined.`,this);return}t=t[r]}if(e!==void 0){if(t[e]===void 0){q(`PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.`,this,t);return}t=t[e]}}let o=t[i];if(o===void 0){let e=n.nodeName;q(`PropertyBinding: Trying to update property for track: `+e+`.`+i+` but it wasn't found.`,t);return}let s=this.Versioning.None;this.targetObject=t,t.isMaterial===!0?s=this.Versioning.NeedsUpdate:t.isObject3D===!0&&(s=this.Versioning.MatrixWorldNeedsUpdate);let c=this.BindingType.Direct;if(a!==void 0){if(i===`morphTargetInfluences`){if(!t.geometry){q(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.`,this);return}if(!t.geometry.morphAttributes){q(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.`,this);return}t.morphTargetDictionary[a]!==void 0&&(a=t.morphTargetDictionary[a])}c=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=a}else o.fromArray!==void 0&&o.toArray!==void 0?(c=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(c=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=i;this.getValue=this.GetterByBindingType[c],this.setValue=this.SetterByBindingTypeAndVersioning[c][s]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};yh.Composite=vh,yh.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3},yh.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2},yh.prototype.GetterByBindingType=[yh.prototype._getValue_direct,yh.prototype._getValue_array,yh.prototype._getValue_arrayElement,yh.prototype._getValue_toArray],yh.prototype.SetterByBindingTypeAndVersioning=[[yh.prototype._setValue_direct,yh.prototype._setValue_direct_setNeedsUpdate,yh.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[yh.prototype._setValue_array,yh.prototype._setValue_array_setNeedsUpdate,yh.prototype._setValue_array_setMatrixWorldNeedsUpdate],[yh.prototype._setValue_arrayElement,yh.prototype._setValue_arrayElement_setNeedsUpdate,yh.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[yh.prototype._setValue_fromArray,yh.prototype._setValue_fromArray_setNeedsUpdate,yh.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var bh=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){let e=1e-6;return this.phi=J(this.phi,e,Math.PI-e),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(J(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};(class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,r){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,r)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,r){let i=this.elements;return i[0]=e,i[2]=t,i[1]=n,i[3]=r,this}});var xh=class extends Gu{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function Sh(e,t,n,r){let i=Ch(r);switch(n){case Dl:return e*t;case Ml:return e*t/i.components*i.byteLength;case Nl:return e*t/i.components*i.byteLength;case Pl:return e*t*2/i.components*i.byteLength;case Fl:return e*t*2/i.components*i.byteLength;case Ol:return e*t*3/i.components*i.byteLength;case kl:return e*t*4/i.components*i.byteLength;case Il:return e*t*4/i.components*i.byteLength;case Ll:case Rl:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case zl:case Bl:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Hl:case Wl:return Math.max(e,16)*Math.max(t,8)/4;case Vl:case Ul:return Math.max(e,8)*Math.max(t,8)/2;case Gl:case Kl:case Jl:case Yl:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case ql:case Xl:case Zl:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Ql:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case $l:return Math.floor((e+4)/5)*Math.floor((t+3)/4)*16;case eu:return Math.floor((e+4)/5)*Math.floor((t+4)/5)*16;case tu:return Math.floor((e+5)/6)*Math.floor((t+4)/5)*16;case nu:return Math.floor((e+5)/6)*Math.floor((t+5)/6)*16;case ru:return Math.floor((e+7)/8)*Math.floor((t+4)/5)*16;case iu:return Math.floor((e+7)/8)*Math.floor((t+5)/6)*16;case au:return Math.floor((e+7)/8)*Math.floor((t+7)/8)*16;case ou:return Math.floor((e+9)/10)*Math.floor((t+4)/5)*16;case su:return Math.floor((e+9)/10)*Math.floor((t+5)/6)*16;case cu:return Math.floor((e+9)/10)*Math.floor((t+7)/8)*16;case lu:return Math.floor((e+9)/10)*Math.floor((t+9)/10)*16;case uu:return Math.floor((e+11)/12)*Math.floor((t+9)/10)*16;case du:return Math.floor((e+11)/12)*Math.floor((t+11)/12)*16;case fu:case pu:case mu:return Math.ceil(e/4)*Math.ceil(t/4)*16;case hu:case gu:return Math.ceil(e/4)*Math.ceil(t/4)*8;case _u:case vu:return Math.ceil(e/4)*Math.ceil(t/4)*16}throw Error(`Unable to determine texture byte length for ${n} format.`)}function Ch(e){switch(e){case ml:case hl:return{byteLength:1,components:1};case _l:case gl:case xl:return{byteLength:2,components:1};case Sl:case Cl:return{byteLength:2,components:4};case yl:case vl:case bl:return{byteLength:4,components:1};case Tl:case El:return{byteLength:4,components:3}}throw Error(`THREE.TextureUtils: Unknown texture type ${e}.`)}typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`register`,{detail:{revision:`187`}})),typeof window<`u`&&(window.__THREE__?K(`WARNING: Multiple instances of Three.js being imported.`):window.__THREE__=`187`);function wh(){let e=null,t=!1,n=null,r=null;function i(t,a){r=e.requestAnimationFrame(i),n(t,a)}return{start:function(){t!==!0&&n!==null&&e!==null&&(r=e.requestAnimationFrame(i),t=!0)},stop:function(){e!==null&&e.cancelAnimationFrame(r),t=!1},setAnimationLoop:function(e){n=e},setContext:function(t){e=t}}}function Th(e){let t=new WeakMap;function n(t,n){let r=t.array,i=t.usage,a=r.byteLength,o=e.createBuffer();e.bindBuffer(n,o),e.bufferData(n,r,i),t.onUploadCallback();let s;if(r instanceof Float32Array)s=e.FLOAT;else if(typeof Float16Array<`u`&&r instanceof Float16Array)s=e.HALF_FLOAT;else if(r instanceof Uint16Array)s=t.isFloat16BufferAttribute?e.HALF_FLOAT:e.UNSIGNED_SHORT;else if(r instanceof Int16Array)s=e.SHORT;else if(r instanceof Uint32Array)s=e.UNSIGNED_INT;else if(r instanceof Int32Array)s=e.INT;else if(r instanceof Int8Array)s=e.BYTE;else if(r instanceof Uint8Array)s=e.UNSIGNED_BYTE;else if(r instanceof Uint8ClampedArray)s=e.UNSIGNED_BYTE;else throw Error(`THREE.WebGLAttributes: Unsupported buffer data format: `+r);return{buffer:o,type:s,bytesPerElement:r.BYTES_PER_ELEMENT,version:t.version,size:a}}function r(t,n,r){let i=n.array,a=n.updateRanges;if(e.bindBuffer(r,t),a.length===0)e.bufferSubData(r,0,i);else{a.sort((e,t)=>e.start-t.start);let t=0;for(let e=1;e<a.length;e++){let n=a[t],r=a[e];r.start<=n.start+n.count+1?n.count=Math.max(n.count,r.start+r.count-n.start):(++t,a[t]=r)}a.length=t+1;for(let t=0,n=a.length;t<n;t++){let n=a[t];e.bufferSubData(r,n.start*i.BYTES_PER_ELEMENT,i,n.start,n.count)}n.clearUpdateRanges()}n.onUploadCallback()}function i(e){return e.isInterleavedBufferAttribute&&(e=e.data),t.get(e)}function a(n){n.isInterleavedBufferAttribute&&(n=n.data);let r=t.get(n);r&&(e.deleteBuffer(r.buffer),t.delete(n))}function o(e,i){if(e.isInterleavedBufferAttribute&&(e=e.data),e.isGLBufferAttribute){let n=t.get(e);(!n||n.version<e.version)&&t.set(e,{buffer:e.buffer,type:e.type,bytesPerElement:e.elementSize,version:e.version});return}let a=t.get(e);if(a===void 0)t.set(e,n(e,i));else if(a.version<e.version){if(a.size!==e.array.byteLength)throw Error(`THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.`);r(a.buffer,e,i),a.version=e.version}}return{get:i,remove:a,update:o}}var Q={alphahash_fragment:`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,alphahash_pars_fragment:`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,alphamap_fragment:`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,alphamap_pars_fragment:`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,alphatest_fragment:`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,alphatest_pars_fragment:`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,aomap_fragment:`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,aomap_pars_fragment:`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,batching_pars_vertex:`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,batching_vertex:`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,begin_vertex:`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,beginnormal_vertex:`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,bsdfs:`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,iridescence_fragment:`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,bumpmap_pars_fragment:`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,clipping_planes_fragment:`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,clipping_planes_pars_fragment:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,clipping_planes_pars_vertex:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,clipping_planes_vertex:`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,color_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,color_pars_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,color_pars_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,color_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,common:`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,defaultnormal_vertex:`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,displacementmap_pars_vertex:`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,displacementmap_vertex:`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,emissivemap_fragment:`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,emissivemap_pars_fragment:`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,colorspace_fragment:`gl_FragColor = linearToOutputTexel( gl_FragColor );`,colorspace_pars_fragment:`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,envmap_fragment:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,envmap_common_pars_fragment:`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,envmap_pars_fragment:`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,envmap_pars_vertex:`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,envmap_physical_pars_fragment:`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,envmap_vertex:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,fog_vertex:`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,fog_pars_vertex:`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,fog_fragment:`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,fog_pars_fragment:`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,gradientmap_pars_fragment:`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,lightmap_pars_fragment:`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,lights_lambert_fragment:`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,lights_lambert_pars_fragment:`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,lights_pars_begin:`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,lights_toon_fragment:`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,lights_toon_pars_fragment:`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,lights_phong_fragment:`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,lights_phong_pars_fragment:`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,lights_physical_fragment:`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,lights_physical_pars_fragment:`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,lights_fragment_begin:`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,lights_fragment_maps:`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,lights_fragment_end:`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,lightprobes_pars_fragment:`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,logdepthbuf_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,logdepthbuf_pars_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_pars_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,map_fragment:`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,map_pars_fragment:`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,map_particle_fragment:`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,map_particle_pars_fragment:`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,metalnessmap_fragment:`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,metalnessmap_pars_fragment:`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,morphinstance_vertex:`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,morphcolor_vertex:`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,morphnormal_vertex:`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,morphtarget_pars_vertex:`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,morphtarget_vertex:`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,normal_fragment_begin:`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,normal_fragment_maps:`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,normal_pars_fragment:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_pars_vertex:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_vertex:`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,normalmap_pars_fragment:`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,clearcoat_normal_fragment_begin:`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,clearcoat_normal_fragment_maps:`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,clearcoat_pars_fragment:`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,iridescence_pars_fragment:`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,opaque_fragment:`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,packing:`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,premultiplied_alpha_fragment:`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,project_vertex:`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,dithering_fragment:`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,dithering_pars_fragment:`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,roughnessmap_fragment:`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,roughnessmap_pars_fragment:`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,shadowmap_pars_fragment:`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,shadowmap_pars_vertex:`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,shadowmap_vertex:`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,shadowmask_pars_fragment:`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,skinbase_vertex:`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,skinning_pars_vertex:`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,skinning_vertex:`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,skinnormal_vertex:`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,specularmap_fragment:`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,specularmap_pars_fragment:`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,tonemapping_fragment:`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,tonemapping_pars_fragment:`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,transmission_fragment:`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,transmission_pars_fragment:`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,uv_pars_fragment:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_pars_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,worldpos_vertex:`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,background_vert:`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,background_frag:`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,backgroundCube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,backgroundCube_frag:`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,cube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,cube_frag:`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,depth_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,depth_frag:`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,distance_vert:`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,distance_frag:`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,equirect_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,equirect_frag:`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,linedashed_vert:`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,linedashed_frag:`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,meshbasic_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,meshbasic_frag:`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshlambert_vert:`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshlambert_frag:`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshmatcap_vert:`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,meshmatcap_frag:`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshnormal_vert:`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,meshnormal_frag:`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,meshphong_vert:`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshphong_frag:`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshphysical_vert:`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,meshphysical_frag:`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshtoon_vert:`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshtoon_frag:`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,points_vert:`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,points_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,shadow_vert:`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,shadow_frag:`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,sprite_vert:`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,sprite_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`},$={common:{diffuse:{value:new wf(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new Z},alphaMap:{value:null},alphaMapTransform:{value:new Z},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new Z}},envmap:{envMap:{value:null},envMapRotation:{value:new Z},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new Z}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new Z}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new Z},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new Z},normalScale:{value:new Y(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new Z},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new Z}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new Z}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new Z}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new wf(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new wf(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new Z},alphaTest:{value:0},uvTransform:{value:new Z}},sprite:{diffuse:{value:new wf(16777215)},opacity:{value:1},center:{value:new Y(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new Z},alphaMap:{value:null},alphaMapTransform:{value:new Z},alphaTest:{value:0}}},Eh={basic:{uniforms:vm([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.fog]),vertexShader:Q.meshbasic_vert,fragmentShader:Q.meshbasic_frag},lambert:{uniforms:vm([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.fog,$.lights,{emissive:{value:new wf(0)},envMapIntensity:{value:1}}]),vertexShader:Q.meshlambert_vert,fragmentShader:Q.meshlambert_frag},phong:{uniforms:vm([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.fog,$.lights,{emissive:{value:new wf(0)},specular:{value:new wf(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:Q.meshphong_vert,fragmentShader:Q.meshphong_frag},standard:{uniforms:vm([$.common,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.roughnessmap,$.metalnessmap,$.fog,$.lights,{emissive:{value:new wf(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:Q.meshphysical_vert,fragmentShader:Q.meshphysical_frag},toon:{uniforms:vm([$.common,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.gradientmap,$.fog,$.lights,{emissive:{value:new wf(0)}}]),vertexShader:Q.meshtoon_vert,fragmentShader:Q.meshtoon_frag},matcap:{uniforms:vm([$.common,$.bumpmap,$.normalmap,$.displacementmap,$.fog,{matcap:{value:null}}]),vertexShader:Q.meshmatcap_vert,fragmentShader:Q.meshmatcap_frag},points:{uniforms:vm([$.points,$.fog]),vertexShader:Q.points_vert,fragmentShader:Q.points_frag},dashed:{uniforms:vm([$.common,$.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:Q.linedashed_vert,fragmentShader:Q.linedashed_frag},depth:{uniforms:vm([$.common,$.displacementmap]),vertexShader:Q.depth_vert,fragmentShader:Q.depth_frag},normal:{uniforms:vm([$.common,$.bumpmap,$.normalmap,$.displacementmap,{opacity:{value:1}}]),vertexShader:Q.meshnormal_vert,fragmentShader:Q.meshnormal_frag},sprite:{uniforms:vm([$.sprite,$.fog]),vertexShader:Q.sprite_vert,fragmentShader:Q.sprite_frag},background:{uniforms:{uvTransform:{value:new Z},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:Q.background_vert,fragmentShader:Q.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new Z}},vertexShader:Q.backgroundCube_vert,fragmentShader:Q.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:Q.cube_vert,fragmentShader:Q.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:Q.equirect_vert,fragmentShader:Q.equirect_frag},distance:{uniforms:vm([$.common,$.displacementmap,{referencePosition:{value:new X},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:Q.distance_vert,fragmentShader:Q.distance_frag},shadow:{uniforms:vm([$.lights,$.fog,{color:{value:new wf(0)},opacity:{value:1}}]),vertexShader:Q.shadow_vert,fragmentShader:Q.shadow_frag}};Eh.physical={uniforms:vm([Eh.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new Z},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new Z},clearcoatNormalScale:{value:new Y(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new Z},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new Z},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new Z},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new Z},sheen:{value:0},sheenColor:{value:new wf(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new Z},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new Z},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new Z},transmissionSamplerSize:{value:new Y},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new Z},attenuationDistance:{value:0},attenuationColor:{value:new wf(0)},specularColor:{value:new wf(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new Z},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new Z},anisotropyVector:{value:new Y},anisotropyMap:{value:null},anisotropyMapTransform:{value:new Z}}]),vertexShader:Q.meshphysical_vert,fragmentShader:Q.meshphysical_frag};var Dh={r:0,b:0,g:0},Oh=new Hd,kh=new Z;kh.set(-1,0,0,0,1,0,0,0,1);function Ah(e,t,n,r,i,a){let o=new wf(0),s=i===!0?0:1,c,l,u=null,d=0,f=null;function p(e){let n=e.isScene===!0?e.background:null;if(n&&n.isTexture){let r=e.backgroundBlurriness>0;n=t.get(n,r)}return n}function m(t){let r=!1,i=p(t);i===null?g(o,s):i&&i.isColor&&(g(i,1),r=!0);let c=e.xr.getEnvironmentBlendMode();c===`additive`?n.buffers.color.setClear(0,0,0,1,a):c===`alpha-blend`&&n.buffers.color.setClear(0,0,0,0,a),(e.autoClear||r)&&(n.buffers.depth.setTest(!0),n.buffers.depth.setMask(!0),n.buffers.color.setMask(!0),e.clear(e.autoClearColor,e.autoClearDepth,e.autoClearStencil))}function h(t,n){let i=p(n);i&&i.isCubeTexture?(l===void 0&&(l=new Wp(new pm(1,1,1),new Tm({name:`BackgroundCubeMaterial`,uniforms:_m(Eh.backgroundCube.uniforms),vertexShader:Eh.backgroundCube.vertexShader,fragmentShader:Eh.backgroundCube.fragmentShader,side:1,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute(`normal`),l.geometry.deleteAttribute(`uv`),l.onBeforeRender=function(e,t,n){this.matrixWorld.copyPosition(n.matrixWorld)},Object.defineProperty(l.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),r.update(l)),l.material.uniforms.envMap.value=i,l.material.uniforms.backgroundBlurriness.value=n.backgroundBlurriness,l.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,l.material.uniforms.backgroundRotation.value.setFromMatrix4(Oh.makeRotationFromEuler(n.backgroundRotation)).transpose(),i.isRenderTargetTexture===!1&&l.material.uniforms.backgroundRotation.value.premultiply(kh),l.material.toneMapped=Ed.getTransfer(i.colorSpace)!==Au,(u!==i||d!==i.version||f!==e.toneMapping)&&(l.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),l.layers.enableAll(),t.unshift(l,l.geometry,l.material,0,0,null)):i&&i.isTexture&&(c===void 0&&(c=new Wp(new hm(2,2),new Tm({name:`BackgroundMaterial`,uniforms:_m(Eh.background.uniforms),vertexShader:Eh.background.vertexShader,fragmentShader:Eh.background.fragmentShader,side:0,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute(`normal`),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),r.update(c)),c.material.uniforms.t2D.value=i,c.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,c.material.toneMapped=Ed.getTransfer(i.colorSpace)!==Au,i.matrixAutoUpdate===!0&&i.updateMatrix(),c.material.uniforms.uvTransform.value.copy(i.matrix),(u!==i||d!==i.version||f!==e.toneMapping)&&(c.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),c.layers.enableAll(),t.unshift(c,c.geometry,c.material,0,0,null))}function g(t,r){t.getRGB(Dh,xm(e)),n.buffers.color.setClear(Dh.r,Dh.g,Dh.b,r,a)}function _(){l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0),c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0)}return{getClearColor:function(){return o},setClearColor:function(e,t=1){o.set(e),s=t,g(o,s)},getClearAlpha:function(){return s},setClearAlpha:function(e){s=e,g(o,s)},render:m,addToRenderList:h,dispose:_}}function jh(e,t){let n=e.getParameter(e.MAX_VERTEX_ATTRIBS),r={},i=f(null),a=i,o=!1;function s(n,r,i,s,c){let u=!1,f=d(n,s,i,r);a!==f&&(a=f,l(a.object)),u=p(n,s,i,c),u&&m(n,s,i,c),c!==null&&t.update(c,e.ELEMENT_ARRAY_BUFFER),(u||o)&&(o=!1,b(n,r,i,s),c!==null&&e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,t.get(c).buffer))}function c(){return e.createVertexArray()}function l(t){return e.bindVertexArray(t)}function u(t){return e.deleteVertexArray(t)}function d(e,t,n,i){let a=i.wireframe===!0,o=r[t.id];o===void 0&&(o={},r[t.id]=o);let s=e.isInstancedMesh===!0?e.id:0,l=o[s];l===void 0&&(l={},o[s]=l);let u=l[n.id];u===void 0&&(u={},l[n.id]=u);let d=u[a];return d===void 0&&(d=f(c()),u[a]=d),d}function f(e){let t=[],r=[],i=[];for(let e=0;e<n;e++)t[e]=0,r[e]=0,i[e]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:t,enabledAttributes:r,attributeDivisors:i,object:e,attributes:{},index:null}}function p(e,t,n,r){let i=a.attributes,o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=i[t],r=o[t];if(r===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(r=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(r=e.instanceColor)),n===void 0||n.attribute!==r||r&&n.data!==r.data)return!0;s++}return a.attributesNum!==s||a.index!==r}function m(e,t,n,r){let i={},o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=o[t];n===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(n=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(n=e.instanceColor));let r={};r.attribute=n,n&&n.data&&(r.data=n.data),i[t]=r,s++}a.attributes=i,a.attributesNum=s,a.index=r}function h(){let e=a.newAttributes;for(let t=0,n=e.length;t<n;t++)e[t]=0}function g(e){_(e,0)}function _(t,n){let r=a.newAttributes,i=a.enabledAttributes,o=a.attributeDivisors;r[t]=1,i[t]===0&&(e.enableVertexAttribArray(t),i[t]=1),o[t]!==n&&(e.vertexAttribDivisor(t,n),o[t]=n)}function v(){let t=a.newAttributes,n=a.enabledAttributes;for(let r=0,i=n.length;r<i;r++)n[r]!==t[r]&&(e.disableVertexAttribArray(r),n[r]=0)}function y(t,n,r,i,a,o,s){s===!0?e.vertexAttribIPointer(t,n,r,a,o):e.vertexAttribPointer(t,n,r,i,a,o)}function b(n,r,i,a){h();let o=a.attributes,s=i.getAttributes(),c=r.defaultAttributeValues;for(let r in s){let i=s[r];if(i.location>=0){let s=o[r];if(s===void 0&&(r===`instanceMatrix`&&n.instanceMatrix&&(s=n.instanceMatrix),r===`instanceColor`&&n.instanceColor&&(s=n.instanceColor)),s!==void 0){let r=s.normalized,o=s.itemSize,c=t.get(s);if(c===void 0)continue;let l=c.buffer,u=c.type,d=c.bytesPerElement,f=u===e.INT||u===e.UNSIGNED_INT||s.gpuType===1013;if(s.isInterleavedBufferAttribute){let t=s.data,c=t.isInterleavedBuffer===!0?t.stride:t.itemSize,p=s.offset;if(t.isInstancedInterleavedBuffer||t.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,t.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=t.meshPerAttribute*t.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,c*d,(p+o/i.locationSize*e)*d,f)}else{if(s.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,s.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=s.meshPerAttribute*s.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,o*d,o/i.locationSize*e*d,f)}}else if(c!==void 0){let t=c[r];if(t!==void 0)switch(t.length){case 2:e.vertexAttrib2fv(i.location,t);break;case 3:e.vertexAttrib3fv(i.location,t);break;case 4:e.vertexAttrib4fv(i.location,t);break;default:e.vertexAttrib1fv(i.location,t)}}}}v()}function x(){T();for(let e in r){let t=r[e];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e]}}function S(e){if(r[e.id]===void 0)return;let t=r[e.id];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e.id]}function C(e){for(let t in r){let n=r[t];for(let t in n){let r=n[t];if(r[e.id]===void 0)continue;let i=r[e.id];for(let e in i)u(i[e].object),delete i[e];delete r[e.id]}}}function w(e){for(let t in r){let n=r[t],i=e.isInstancedMesh===!0?e.id:0,a=n[i];if(a!==void 0){for(let e in a){let t=a[e];for(let e in t)u(t[e].object),delete t[e];delete a[e]}delete n[i],Object.keys(n).length===0&&delete r[t]}}}function T(){E(),o=!0,a!==i&&(a=i,l(a.object))}function E(){i.geometry=null,i.program=null,i.wireframe=!1}return{setup:s,reset:T,resetDefaultState:E,dispose:x,releaseStatesOfGeometry:S,releaseStatesOfObject:w,releaseStatesOfProgram:C,initAttributes:h,enableAttribute:g,disableUnusedAttributes:v}}function Mh(e,t,n){let r;function i(e){r=e}function a(t,i){e.drawArrays(r,t,i),n.update(i,r,1)}function o(t,i,a){a!==0&&(e.drawArraysInstanced(r,t,i,a),n.update(i,r,a))}function s(e,i,a){if(a===0)return;t.get(`WEBGL_multi_draw`).multiDrawArraysWEBGL(r,e,0,i,0,a);let o=0;for(let e=0;e<a;e++)o+=i[e];n.update(o,r,1)}this.setMode=i,this.render=a,this.renderInstances=o,this.renderMultiDraw=s}function Nh(e,t,n,r){let i;function a(){if(i!==void 0)return i;if(t.has(`EXT_texture_filter_anisotropic`)===!0){let n=t.get(`EXT_texture_filter_anisotropic`);i=e.getParameter(n.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else i=0;return i}function o(t){return t===1023||r.convert(t)===e.getParameter(e.IMPLEMENTATION_COLOR_READ_FORMAT)}function s(n){let i=n===1016&&(t.has(`EXT_color_buffer_half_float`)||t.has(`EXT_color_buffer_float`));return!(n!==1009&&n!==1015&&!i&&r.convert(n)!==e.getParameter(e.IMPLEMENTATION_COLOR_READ_TYPE))}function c(t){if(t===`highp`){if(e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.HIGH_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.HIGH_FLOAT).precision>0)return`highp`;t=`mediump`}return t===`mediump`&&e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.MEDIUM_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.MEDIUM_FLOAT).precision>0?`mediump`:`lowp`}let l=n.precision===void 0?`highp`:n.precision,u=c(l);u!==l&&(K(`WebGLRenderer:`,l,`not supported, using`,u,`instead.`),l=u);let d=n.reversedDepthBuffer===!0&&t.has(`EXT_clip_control`),f=n.logarithmicDepthBuffer===!0&&d===!1;n.reversedDepthBuffer===!0&&d===!1&&K(`WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer.`),n.logarithmicDepthBuffer===!0&&d===!0&&K(`WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.`);let p=e.getParameter(e.MAX_TEXTURE_IMAGE_UNITS),m=e.getParameter(e.MAX_VERTEX_TEXTURE_IMAGE_UNITS),h=e.getParameter(e.MAX_TEXTURE_SIZE),g=e.getParameter(e.MAX_CUBE_MAP_TEXTURE_SIZE),_=e.getParameter(e.MAX_VERTEX_ATTRIBS),v=e.getParameter(e.MAX_VERTEX_UNIFORM_VECTORS),y=e.getParameter(e.MAX_VARYING_VECTORS),b=e.getParameter(e.MAX_FRAGMENT_UNIFORM_VECTORS),x=e.getParameter(e.MAX_SAMPLES),S=e.getParameter(e.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:a,getMaxPrecision:c,textureFormatReadable:o,textureTypeReadable:s,precision:l,logarithmicDepthBuffer:f,reversedDepthBuffer:d,maxTextures:p,maxVertexTextures:m,maxTextureSize:h,maxCubemapSize:g,maxAttributes:_,maxVertexUniforms:v,maxVaryings:y,maxFragmentUniforms:b,maxSamples:x,samples:S}}function Ph(e){let t=this,n=null,r=0,i=!1,a=!1,o=new wp,s=new Z,c={value:null,needsUpdate:!1};this.uniform=c,this.numPlanes=0,this.numIntersection=0,this.init=function(e,t){let n=e.length!==0||t||r!==0||i;return i=t,r=e.length,n},this.beginShadows=function(){a=!0,u(null)},this.endShadows=function(){a=!1},this.setGlobalState=function(e,t){n=u(e,t,0)},this.setState=function(t,o,s){let d=t.clippingPlanes,f=t.clipIntersection,p=t.clipShadows,m=e.get(t);if(!i||d===null||d.length===0||a&&!p)a?u(null):l();else{let e=a?0:r,t=e*4,i=m.clippingState||null;c.value=i,i=u(d,o,t,s);for(let e=0;e!==t;++e)i[e]=n[e];m.clippingState=i,this.numIntersection=f?this.numPlanes:0,this.numPlanes+=e}};function l(){c.value!==n&&(c.value=n,c.needsUpdate=r>0),t.numPlanes=r,t.numIntersection=0}function u(e,n,r,i){let a=e===null?0:e.length,l=null;if(a!==0){if(l=c.value,i!==!0||l===null){let t=r+a*4,i=n.matrixWorldInverse;s.getNormalMatrix(i),(l===null||l.length<t)&&(l=new Float32Array(t));for(let t=0,n=r;t!==a;++t,n+=4)o.copy(e[t]).applyMatrix4(i,s),o.normal.toArray(l,n),l[n+3]=o.constant}c.value=l,c.needsUpdate=!0}return t.numPlanes=a,t.numIntersection=0,l}}var Fh=class extends zd{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},r=[n,n,n,n,n,n];this.texture=new lm(r),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},r=new pm(5,5,5),i=new Tm({name:`CubemapFromEquirect`,uniforms:_m(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:1,blending:0});i.uniforms.tEquirect.value=t;let a=new Wp(r,i),o=t.minFilter;return t.minFilter===1008&&(t.minFilter=dl),new oh(1,10,this).update(e,a),t.minFilter=o,a.geometry.dispose(),a.material.dispose(),this}clear(e,t=!0,n=!0,r=!0){let i=e.getRenderTarget();for(let i=0;i<6;i++)e.setRenderTarget(this,i),e.clear(t,n,r);e.setRenderTarget(i)}},Ih=256,Lh=3,Rh=20,zh=256,Bh=16,Vh=3,Hh=new X,Uh=new wf,Wh=class e{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new oh(1,10,null),this._boxMesh=new Wp(new pm(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,r=100,i={}){let{size:a=256,position:o=Hh}=i,s=this._renderer;this._setSize(a);let c=this._allocateTarget(),l=this._getSourceTarget(!0);t>0&&(l.texture.mipmapsAutoUpdate=!1);let u=s.autoClear,d=s.autoClearColor,f=s.autoClearDepth,p=s.autoClearStencil,m=e.background;s.autoClear=!0,s.autoClearColor=!0,s.autoClearDepth=!0,s.autoClearStencil=!0,m===null&&(e.background=s.getClearColor(Uh));let h=new oh(n,r,l);return h.position.copy(o),h.update(s,e),s.autoClear=u,s.autoClearColor=d,s.autoClearDepth=f,s.autoClearStencil=p,e.background=m,t>0&&(l.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=Zh(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Xh(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(Ih,pd(e))}_fromTexture(e,t){e.mapping===301||e.mapping===302?this._setSize(e.image.length===0?Ih:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=Gh(e,!1,!1),n=Math.log2(e)-Lh;for(let r=0;r<=n;r++)t.texture.mipmaps.push({width:e>>r,height:e>>r});return t.texture.name=`PMREM`,t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Gh(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let r=this._boxMesh,i=this._cubeCamera;r.material=n,i.renderTarget=e,i.activeMipmapLevel=t;let a=e.width>>t;e.viewport.set(0,0,a,a),i.update(this._renderer,r),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===301||e.mapping===302?(this._cubemapMaterial===null&&(this._cubemapMaterial=Zh()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=Xh()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=qh(),this._integrationMaterial=Jh());let n=this._cubeSize,r=t.texture.mipmaps.length-1,i=this._ggxMaterial.uniforms;i.envMap.value=this._sourceTarget.texture;let a=this._integrationMaterial.uniforms;a.envMap.value=this._sourceTarget.texture,a.sourceLod.value=Math.log2(n/Bh);for(let o=0;o<=r;o++){let s=e.lodToRoughness(o,r);if(o>r-Vh)a.roughness.value=s,this._renderCube(t,o,this._integrationMaterial);else{let e=s>0?Math.log2(n)+.5*Math.log2(6/(zh*s**4))+.5:0;i.roughness.value=s,i.lodBias.value=e,this._renderCube(t,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=Yh());let n=this._blurMaterial,r=n.uniforms,i=this._sourceTarget;r.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,r.envMap.value=i.texture,this._renderCube(e,0,n),r.envMap.value=e.texture,this._renderCube(i,0,n)}};function Gh(e,t,n){return new Fh(e,{minFilter:pl,generateMipmaps:t,type:xl,colorSpace:Ou,depthBuffer:n})}function Kh(e,t,n){return new Tm({name:e,uniforms:t,vertexShader:Q.cube_vert,fragmentShader:n,side:1,blending:0,depthTest:!1,depthWrite:!1})}function qh(){return Kh(`PMREMGGXConvolution`,{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${zh}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Jh(){return Kh(`PMREMGGXIntegration`,{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Bh}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Yh(){return Kh(`PMREMSphericalGaussianBlur`,{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${Rh}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function Xh(){return Kh(`PMREMEquirectangularToCubemap`,{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function Zh(){return Kh(`PMREMCubemapToCubemap`,{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function Qh(e){let t=new WeakMap,n=new WeakMap,r=null;function i(e,t=!1){return e==null?null:t?o(e):a(e)}function a(n){if(n&&n.isTexture){let r=n.mapping;if(r===303||r===304){if(t.has(n)){let e=t.get(n).texture;return s(e,n.mapping)}{let r=n.image;if(r&&r.height>0){let i=new Fh(r.height);return i.fromEquirectangularTexture(e,n),t.set(n,i),n.addEventListener(`dispose`,l),s(i.texture,n.mapping)}return null}}}return n}function o(t){if(t&&t.isTexture&&t.isPMREMTexture!==!0){let i=t.mapping,a=i===303||i===304,o=i===301||i===302;if(a||o){let i=n.get(t),s=i===void 0?0:i.texture.pmremVersion;if(t.isRenderTargetTexture&&t.pmremVersion!==s)return r===null&&(r=new Wh(e)),i=a?r.fromEquirectangular(t,i):r.fromCubemap(t,i),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),i.texture;if(i!==void 0)return i.texture;{let s=t.image;return a&&s&&s.height>0||o&&s&&c(s)?(r===null&&(r=new Wh(e)),i=a?r.fromEquirectangular(t):r.fromCubemap(t),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),t.addEventListener(`dispose`,u),i.texture):null}}}return t}function s(e,t){return t===303?e.mapping=301:t===304&&(e.mapping=302),e}function c(e){let t=0;for(let n=0;n<6;n++)e[n]!==void 0&&t++;return t===6}function l(e){let n=e.target;n.removeEventListener(`dispose`,l);let r=t.get(n);r!==void 0&&(t.delete(n),r.dispose())}function u(e){let t=e.target;t.removeEventListener(`dispose`,u);let r=n.get(t);r!==void 0&&(n.delete(t),r.dispose())}function d(){t=new WeakMap,n=new WeakMap,r!==null&&(r.dispose(),r=null)}return{get:i,dispose:d}}function $h(e){let t={};function n(n){if(t[n]!==void 0)return t[n];let r=e.getExtension(n);return t[n]=r,r}return{has:function(e){return n(e)!==null},init:function(){n(`EXT_color_buffer_float`),n(`WEBGL_clip_cull_distance`),n(`OES_texture_float_linear`),n(`EXT_color_buffer_half_float`),n(`WEBGL_multisampled_render_to_texture`),n(`WEBGL_render_shared_exponent`)},get:function(e){let t=n(e);return t===null&&Hu(`WebGLRenderer: `+e+` extension not supported.`),t}}}function eg(e,t,n,r){let i={},a=new WeakMap,o=new FinalizationRegistry(e=>delete i[e]);function s(e){c(e.target)}function c(e){e.index!==null&&t.remove(e.index);for(let n in e.attributes)t.remove(e.attributes[n]);e.removeEventListener(`dispose`,s),delete i[e.id],o.unregister(e);let c=a.get(e);c&&(t.remove(c),a.delete(e)),r.releaseStatesOfGeometry(e),e.isInstancedBufferGeometry===!0&&delete e._maxInstanceCount,n.memory.geometries--}function l(e,t){return i[t.id]===void 0&&(t.addEventListener(`dispose`,s),i[t.id]=new WeakRef(t),o.register(t,t.id,t),n.memory.geometries++),t}function u(n){let r=n.attributes;for(let n in r)t.update(r[n],e.ARRAY_BUFFER)}function d(e){let n=e.index,r=e.attributes.position,i=0;if(r===void 0)return;let o=n===null?r.array.length/3-1:n.array.length,s=new(r.count>=65535?sp:op)(Math.ceil(o/3)*6,1),c=s.array;if(n!==null){let e=n.array;i=n.version;for(let t=0,n=0;t<o;t+=3){let r=e[t+0],i=e[t+1],a=e[t+2];c[n++]=r,c[n++]=i,c[n++]=i,c[n++]=a,c[n++]=a,c[n++]=r}}else{i=r.version;for(let e=0,t=0;e<o;e+=3){let n=e+0,r=e+1,i=e+2;c[t++]=n,c[t++]=r,c[t++]=r,c[t++]=i,c[t++]=i,c[t++]=n}}s.version=i;let l=a.get(e);l&&t.remove(l),a.set(e,s)}function f(e){let t=a.get(e);if(t){let n=e.index;n!==null&&t.version<n.version&&d(e)}else d(e);return a.get(e)}function p(){for(let e in i){let t=i[e].deref();t!==void 0&&c(t)}}return{get:l,update:u,getWireframeAttribute:f,dispose:p}}function tg(e,t,n){let r;function i(e){r=e}let a,o;function s(e){a=e.type,o=e.bytesPerElement}function c(t,i){e.drawElements(r,i,a,t*o),n.update(i,r,1)}function l(t,i,s){s!==0&&(e.drawElementsInstanced(r,i,a,t*o,s),n.update(i,r,s))}function u(e,i,o){if(o===0)return;t.get(`WEBGL_multi_draw`).multiDrawElementsWEBGL(r,i,0,a,e,0,o);let s=0;for(let e=0;e<o;e++)s+=i[e];n.update(s,r,1)}this.setMode=i,this.setIndex=s,this.render=c,this.renderInstances=l,this.renderMultiDraw=u}function ng(e){let t={geometries:0,textures:0},n={frame:0,calls:0,triangles:0,points:0,lines:0};function r(t,r,i){switch(n.calls++,r){case e.TRIANGLES:n.triangles+=t/3*i;break;case e.LINES:n.lines+=t/2*i;break;case e.LINE_STRIP:n.lines+=i*(t-1);break;case e.LINE_LOOP:n.lines+=i*t;break;case e.POINTS:n.points+=i*t;break;default:q(`WebGLInfo: Unknown draw mode:`,r)}}function i(){n.calls=0,n.triangles=0,n.points=0,n.lines=0}return{memory:t,render:n,programs:null,autoReset:!0,reset:i,update:r}}function rg(e,t,n){let r=new WeakMap,i=new Ld;function a(a,o,s){let c=a.morphTargetInfluences,l=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,u=l===void 0?0:l.length,d=r.get(o);if(d===void 0||d.count!==u){d!==void 0&&d.texture.dispose();let e=o.morphAttributes.position!==void 0,n=o.morphAttributes.normal!==void 0,a=o.morphAttributes.color!==void 0,s=o.morphAttributes.position||[],c=o.morphAttributes.normal||[],l=o.morphAttributes.color||[],f=0;e===!0&&(f=1),n===!0&&(f=2),a===!0&&(f=3);let p=o.attributes.position.count*f,m=1;p>t.maxTextureSize&&(m=Math.ceil(p/t.maxTextureSize),p=t.maxTextureSize);let h=new Float32Array(p*m*4*u),g=new Bd(h,p,m,u);g.type=bl,g.needsUpdate=!0;let _=f*4;for(let t=0;t<u;t++){let r=s[t],o=c[t],u=l[t],d=p*m*4*t;for(let t=0;t<r.count;t++){let s=t*_;e===!0&&(i.fromBufferAttribute(r,t),h[d+s+0]=i.x,h[d+s+1]=i.y,h[d+s+2]=i.z,h[d+s+3]=0),n===!0&&(i.fromBufferAttribute(o,t),h[d+s+4]=i.x,h[d+s+5]=i.y,h[d+s+6]=i.z,h[d+s+7]=0),a===!0&&(i.fromBufferAttribute(u,t),h[d+s+8]=i.x,h[d+s+9]=i.y,h[d+s+10]=i.z,h[d+s+11]=u.itemSize===4?i.w:1)}}d={count:u,texture:g,size:new Y(p,m)},r.set(o,d);function v(){g.dispose(),r.delete(o),o.removeEventListener(`dispose`,v)}o.addEventListener(`dispose`,v)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)s.getUniforms().setValue(e,`morphTexture`,a.morphTexture,n);else{let t=0;for(let e=0;e<c.length;e++)t+=c[e];let n=o.morphTargetsRelative?1:1-t;s.getUniforms().setValue(e,`morphTargetBaseInfluence`,n),s.getUniforms().setValue(e,`morphTargetInfluences`,c)}s.getUniforms().setValue(e,`morphTargetsTexture`,d.texture,n),s.getUniforms().setValue(e,`morphTargetsTextureSize`,d.size)}return{update:a}}function ig(e,t,n,r,i){let a=new WeakMap;function o(r){let o=i.render.frame,s=r.geometry,l=t.get(r,s);if(a.get(l)!==o&&(t.update(l),a.set(l,o)),r.isInstancedMesh&&(r.hasEventListener(`dispose`,c)===!1&&r.addEventListener(`dispose`,c),a.get(r)!==o&&(n.update(r.instanceMatrix,e.ARRAY_BUFFER),r.instanceColor!==null&&n.update(r.instanceColor,e.ARRAY_BUFFER),a.set(r,o))),r.isSkinnedMesh){let e=r.skeleton;a.get(e)!==o&&(e.update(),a.set(e,o))}return l}function s(){a=new WeakMap}function c(e){let t=e.target;t.removeEventListener(`dispose`,c),r.releaseStatesOfObject(t),n.remove(t.instanceMatrix),t.instanceColor!==null&&n.remove(t.instanceColor)}return{update:o,dispose:s}}var ag={1:`LINEAR_TONE_MAPPING`,2:`REINHARD_TONE_MAPPING`,3:`CINEON_TONE_MAPPING`,4:`ACES_FILMIC_TONE_MAPPING`,6:`AGX_TONE_MAPPING`,7:`NEUTRAL_TONE_MAPPING`,5:`CUSTOM_TONE_MAPPING`};function og(e,t,n,r,i,a){let o=new zd(t,n,{type:e,depthBuffer:i,stencilBuffer:a,samples:r?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),s=null,c=null,l=null,u=new bp;u.setAttribute(`position`,new cp([-1,3,0,-1,-1,0,3,-1,0],3)),u.setAttribute(`uv`,new cp([0,2,0,0,2,0],2));let d=new Em({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new Wp(u,d),p=new rh(-1,1,1,-1,0,1),m=null,h=null,g=!1,_,v=null,y=[],b=!1;this.setSize=function(e,t){o.setSize(e,t),s!==null&&s.setSize(e,t),c!==null&&c.setSize(e,t);for(let n=0;n<y.length;n++){let r=y[n];r.setSize&&r.setSize(e,t)}},this.setEffects=function(e){y=e,b=y.length>0&&y[0].isRenderPass===!0;let t=o.width,n=o.height;y.length>0&&s===null&&(s=new zd(t,n,{type:xl,depthBuffer:!1,stencilBuffer:!1}),c=new zd(t,n,{type:xl,depthBuffer:!1,stencilBuffer:!1}));let r=i===!0&&y.some(e=>e.needsDepthTexture===!0);r!==(o.depthTexture!==null)&&(r===!0&&l===null&&(l=new um(t,n),a===!0&&(l.format=jl,l.type=wl)),o.dispose(),o.depthTexture=r?l:null,o.resolveDepthBuffer=r,o.storeMultisampledDepthBuffer=r);for(let e=0;e<y.length;e++){let i=y[e];i.setSize&&i.setSize(t,n),r&&i.needsDepthTexture===!0&&i.setDepthTexture&&i.setDepthTexture(l)}},this.begin=function(e,t){if(g||e.toneMapping===0&&y.length===0)return!1;if(v=t,t!==null){let e=t.width,n=t.height;(o.width!==e||o.height!==n)&&this.setSize(e,n)}return b===!1&&e.setRenderTarget(o),_=e.toneMapping,e.toneMapping=0,!0},this.hasRenderPass=function(){return b},this.end=function(e,t){e.toneMapping=_,g=!0;let n=o,r=s;for(let i=0;i<y.length;i++){let a=y[i];a.enabled!==!1&&(a.render(e,r,n,t),a.needsSwap!==!1&&(n=r,r=r===s?c:s))}if(m!==e.outputColorSpace||h!==e.toneMapping){m=e.outputColorSpace,h=e.toneMapping,d.defines={},Ed.getTransfer(m)===`srgb`&&(d.defines.SRGB_TRANSFER=``);let t=ag[h];t&&(d.defines[t]=``),d.needsUpdate=!0}d.uniforms.tDiffuse.value=n.texture,e.setRenderTarget(v),e.render(f,p),v=null,g=!1},this.isCompositing=function(){return g},this.dispose=function(){o.dispose(),s!==null&&s.dispose(),c!==null&&c.dispose(),u.dispose(),d.dispose()}}var sg=new Id,cg=new um(1,1),lg=new dm(1),ug=new Bd,dg=new Vd,fg=new lm,pg=[],mg=[],hg=new Float32Array(16),gg=new Float32Array(9),_g=new Float32Array(4);function vg(e,t,n){let r=e[0];if(r<=0||r>0)return e;let i=t*n,a=pg[i];if(a===void 0&&(a=new Float32Array(i),pg[i]=a),t!==0){r.toArray(a,0);for(let r=1,i=0;r!==t;++r)i+=n,e[r].toArray(a,i)}return a}function yg(e,t){if(e.length!==t.length)return!1;for(let n=0,r=e.length;n<r;n++)if(e[n]!==t[n])return!1;return!0}function bg(e,t){for(let n=0,r=t.length;n<r;n++)e[n]=t[n]}function xg(e,t){let n=mg[t];n===void 0&&(n=new Int32Array(t),mg[t]=n);for(let r=0;r!==t;++r)n[r]=e.allocateTextureUnit();return n}function Sg(e,t){let n=this.cache;n[0]!==t&&(e.uniform1f(this.addr,t),n[0]=t)}function Cg(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2f(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(yg(n,t))return;e.uniform2fv(this.addr,t),bg(n,t)}}function wg(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3f(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else if(t.r!==void 0)(n[0]!==t.r||n[1]!==t.g||n[2]!==t.b)&&(e.uniform3f(this.addr,t.r,t.g,t.b),n[0]=t.r,n[1]=t.g,n[2]=t.b);else{if(yg(n,t))return;e.uniform3fv(this.addr,t),bg(n,t)}}function Tg(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4f(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(yg(n,t))return;e.uniform4fv(this.addr,t),bg(n,t)}}function Eg(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(yg(n,t))return;e.uniformMatrix2fv(this.addr,!1,t),bg(n,t)}else{if(yg(n,r))return;_g.set(r),e.uniformMatrix2fv(this.addr,!1,_g),bg(n,r)}}function Dg(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(yg(n,t))return;e.uniformMatrix3fv(this.addr,!1,t),bg(n,t)}else{if(yg(n,r))return;gg.set(r),e.uniformMatrix3fv(this.addr,!1,gg),bg(n,r)}}function Og(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(yg(n,t))return;e.uniformMatrix4fv(this.addr,!1,t),bg(n,t)}else{if(yg(n,r))return;hg.set(r),e.uniformMatrix4fv(this.addr,!1,hg),bg(n,r)}}function kg(e,t){let n=this.cache;n[0]!==t&&(e.uniform1i(this.addr,t),n[0]=t)}function Ag(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2i(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(yg(n,t))return;e.uniform2iv(this.addr,t),bg(n,t)}}function jg(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3i(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(yg(n,t))return;e.uniform3iv(this.addr,t),bg(n,t)}}function Mg(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4i(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(yg(n,t))return;e.uniform4iv(this.addr,t),bg(n,t)}}function Ng(e,t){let n=this.cache;n[0]!==t&&(e.uniform1ui(this.addr,t),n[0]=t)}function Pg(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2ui(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(yg(n,t))return;e.uniform2uiv(this.addr,t),bg(n,t)}}function Fg(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3ui(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(yg(n,t))return;e.uniform3uiv(this.addr,t),bg(n,t)}}function Ig(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4ui(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(yg(n,t))return;e.uniform4uiv(this.addr,t),bg(n,t)}}function Lg(e){return e.version===0&&(e.compareFunction=519,e.needsUpdate=!0),e}function Rg(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_2D_SHADOW?Lg(cg):sg,n.setTexture2D(t||a,i)}function zg(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture3D(t||dg,i)}function Bg(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_CUBE_SHADOW?Lg(lg):fg,n.setTextureCube(t||a,i)}function Vg(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture2DArray(t||ug,i)}function Hg(e){switch(e){case 5126:return Sg;case 35664:return Cg;case 35665:return wg;case 35666:return Tg;case 35674:return Eg;case 35675:return Dg;case 35676:return Og;case 5124:case 35670:return kg;case 35667:case 35671:return Ag;case 35668:case 35672:return jg;case 35669:case 35673:return Mg;case 5125:return Ng;case 36294:return Pg;case 36295:return Fg;case 36296:return Ig;case 35678:case 36198:case 36298:case 36306:case 35682:return Rg;case 35679:case 36299:case 36307:return zg;case 35680:case 36300:case 36308:case 36293:return Bg;case 36289:case 36303:case 36311:case 36292:return Vg}}function Ug(e,t){e.uniform1fv(this.addr,t)}function Wg(e,t){let n=vg(t,this.size,2);e.uniform2fv(this.addr,n)}function Gg(e,t){let n=vg(t,this.size,3);e.uniform3fv(this.addr,n)}function Kg(e,t){let n=vg(t,this.size,4);e.uniform4fv(this.addr,n)}function qg(e,t){let n=vg(t,this.size,4);e.uniformMatrix2fv(this.addr,!1,n)}function Jg(e,t){let n=vg(t,this.size,9);e.uniformMatrix3fv(this.addr,!1,n)}function Yg(e,t){let n=vg(t,this.size,16);e.uniformMatrix4fv(this.addr,!1,n)}function Xg(e,t){e.uniform1iv(this.addr,t)}function Zg(e,t){e.uniform2iv(this.addr,t)}function Qg(e,t){e.uniform3iv(this.addr,t)}function $g(e,t){e.uniform4iv(this.addr,t)}function e_(e,t){e.uniform1uiv(this.addr,t)}function t_(e,t){e.uniform2uiv(this.addr,t)}function n_(e,t){e.uniform3uiv(this.addr,t)}function r_(e,t){e.uniform4uiv(this.addr,t)}function i_(e,t,n){let r=this.cache,i=t.length,a=xg(n,i);yg(r,a)||(e.uniform1iv(this.addr,a),bg(r,a));let o;o=this.type===e.SAMPLER_2D_SHADOW?Lg(cg):sg;for(let e=0;e!==i;++e)n.setTexture2D(t[e]||o,a[e])}function a_(e,t,n){let r=this.cache,i=t.length,a=xg(n,i);yg(r,a)||(e.uniform1iv(this.addr,a),bg(r,a));for(let e=0;e!==i;++e)n.setTexture3D(t[e]||dg,a[e])}function o_(e,t,n){let r=this.cache,i=t.length,a=xg(n,i);yg(r,a)||(e.uniform1iv(this.addr,a),bg(r,a));let o;o=this.type===e.SAMPLER_CUBE_SHADOW?Lg(lg):fg;for(let e=0;e!==i;++e)n.setTextureCube(t[e]||o,a[e])}function s_(e,t,n){let r=this.cache,i=t.length,a=xg(n,i);yg(r,a)||(e.uniform1iv(this.addr,a),bg(r,a));for(let e=0;e!==i;++e)n.setTexture2DArray(t[e]||ug,a[e])}function c_(e){switch(e){case 5126:return Ug;case 35664:return Wg;case 35665:return Gg;case 35666:return Kg;case 35674:return qg;case 35675:return Jg;case 35676:return Yg;case 5124:case 35670:return Xg;case 35667:case 35671:return Zg;case 35668:case 35672:return Qg;case 35669:case 35673:return $g;case 5125:return e_;case 36294:return t_;case 36295:return n_;case 36296:return r_;case 35678:case 36198:case 36298:case 36306:case 35682:return i_;case 35679:case 36299:case 36307:return a_;case 35680:case 36300:case 36308:case 36293:return o_;case 36289:case 36303:case 36311:case 36292:return s_}}var l_=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=Hg(t.type)}},u_=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=c_(t.type)}},d_=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let r=this.seq;for(let i=0,a=r.length;i!==a;++i){let a=r[i];a.setValue(e,t[a.id],n)}}},f_=/(\w+)(\])?(\[|\.)?/g;function p_(e,t){e.seq.push(t),e.map[t.id]=t}function m_(e,t,n){let r=e.name,i=r.length;for(f_.lastIndex=0;;){let a=f_.exec(r),o=f_.lastIndex,s=a[1],c=a[2]===`]`,l=a[3];if(c&&(s|=0),l===void 0||l===`[`&&o+2===i){p_(n,l===void 0?new l_(s,e,t):new u_(s,e,t));break}{let e=n.map[s];e===void 0&&(e=new d_(s),p_(n,e)),n=e}}}var h_=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let r=0;r<n;++r){let n=e.getActiveUniform(t,r);m_(n,e.getUniformLocation(t,n.name),this)}let r=[],i=[];for(let t of this.seq)t.type===e.SAMPLER_2D_SHADOW||t.type===e.SAMPLER_CUBE_SHADOW||t.type===e.SAMPLER_2D_ARRAY_SHADOW?r.push(t):i.push(t);r.length>0&&(this.seq=r.concat(i))}setValue(e,t,n,r){let i=this.map[t];i!==void 0&&i.setValue(e,n,r)}setOptional(e,t,n){let r=t[n];r!==void 0&&this.setValue(e,n,r)}static upload(e,t,n,r){for(let i=0,a=t.length;i!==a;++i){let a=t[i],o=n[a.id];o.needsUpdate!==!1&&a.setValue(e,o.value,r)}}static seqWithValue(e,t){let n=[];for(let r=0,i=e.length;r!==i;++r){let i=e[r];i.id in t&&n.push(i)}return n}};function g_(e,t,n){let r=e.createShader(t);return e.shaderSource(r,n),e.compileShader(r),r}var __=37297,v_=0;function y_(e,t){let n=e.split(`
`),r=[],i=Math.max(t-6,0),a=Math.min(t+6,n.length);for(let e=i;e<a;e++){let i=e+1;r.push(`${i===t?`>`:` `} ${i}: ${n[e]}`)}return r.join(`
`)}var b_=new Z;function x_(e){Ed._getMatrix(b_,Ed.workingColorSpace,e);let t=`mat3( ${b_.elements.map(e=>e.toFixed(4))} )`;switch(Ed.getTransfer(e)){case ku:return[t,`LinearTransferOETF`];case Au:return[t,`sRGBTransferOETF`];default:return K(`WebGLProgram: Unsupported color space: `,e),[t,`LinearTransferOETF`]}}function S_(e,t,n){let r=e.getShaderParameter(t,e.COMPILE_STATUS),i=(e.getShaderInfoLog(t)||``).trim();if(r&&i===``)return``;let a=/ERROR: 0:(\d+)/.exec(i);if(a){let r=parseInt(a[1]);return n.toUpperCase()+`

`+i+`

`+y_(e.getShaderSource(t),r)}return i}function C_(e,t){let n=x_(t);return[`vec4 ${e}( vec4 value ) {`,`	return ${n[1]}( vec4( ${n[0]} * value.rgb, value.a ) );`,`}`].join(`
`)}var w_={1:`Linear`,2:`Reinhard`,3:`Cineon`,4:`ACESFilmic`,6:`AgX`,7:`Neutral`,5:`Custom`};function T_(e,t){let n=w_[t];return n===void 0?(K(`WebGLProgram: Unsupported toneMapping:`,t),`vec3 `+e+`( vec3 color ) { return LinearToneMapping( color ); }`):`vec3 `+e+`( vec3 color ) { return `+n+`ToneMapping( color ); }`}var E_=new X;function D_(){return Ed.getLuminanceCoefficients(E_),[`float luminance( const in vec3 rgb ) {`,`	const vec3 weights = vec3( ${E_.x.toFixed(4)}, ${E_.y.toFixed(4)}, ${E_.z.toFixed(4)} );`,`	return dot( weights, rgb );`,`}`].join(`
`)}function O_(e){return[e.extensionClipCullDistance?`#extension GL_ANGLE_clip_cull_distance : require`:``,e.extensionMultiDraw?`#extension GL_ANGLE_multi_draw : require`:``].filter(j_).join(`
`)}function k_(e){let t=[];for(let n in e){let r=e[n];r!==!1&&t.push(`#define `+n+` `+r)}return t.join(`
`)}function A_(e,t){let n={},r=e.getProgramParameter(t,e.ACTIVE_ATTRIBUTES);for(let i=0;i<r;i++){let r=e.getActiveAttrib(t,i),a=r.name,o=1;r.type===e.FLOAT_MAT2&&(o=2),r.type===e.FLOAT_MAT3&&(o=3),r.type===e.FLOAT_MAT4&&(o=4),n[a]={type:r.type,location:e.getAttribLocation(t,a),locationSize:o}}return n}function j_(e){return e!==``}function M_(e,t){let n=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return e.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,n).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function N_(e,t){return e.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var P_=/^[ \t]*#include +<([\w\d./]+)>/gm;function F_(e){return e.replace(P_,I_)}function I_(e,t){let n=Q[t];if(n===void 0)throw Error(`THREE.WebGLProgram: Can not resolve #include <`+t+`>`);return F_(n)}var L_=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function R_(e){return e.replace(L_,z_)}function z_(e,t,n,r){let i=``;for(let e=parseInt(t);e<parseInt(n);e++)i+=r.replace(/\[\s*i\s*\]/g,`[ `+e+` ]`).replace(/UNROLLED_LOOP_INDEX/g,e);return i}function B_(e){let t=`precision ${e.precision} float;
	precision ${e.precision} int;
	precision ${e.precision} sampler2D;
	precision ${e.precision} samplerCube;
	precision ${e.precision} sampler3D;
	precision ${e.precision} sampler2DArray;
	precision ${e.precision} sampler2DShadow;
	precision ${e.precision} samplerCubeShadow;
	precision ${e.precision} sampler2DArrayShadow;
	precision ${e.precision} isampler2D;
	precision ${e.precision} isampler3D;
	precision ${e.precision} isamplerCube;
	precision ${e.precision} isampler2DArray;
	precision ${e.precision} usampler2D;
	precision ${e.precision} usampler3D;
	precision ${e.precision} usamplerCube;
	precision ${e.precision} usampler2DArray;
	`;return e.precision===`highp`?t+=`
#define HIGH_PRECISION`:e.precision===`mediump`?t+=`
#define MEDIUM_PRECISION`:e.precision===`lowp`&&(t+=`
#define LOW_PRECISION`),t}var V_={1:`SHADOWMAP_TYPE_PCF`,3:`SHADOWMAP_TYPE_VSM`};function H_(e){return V_[e.shadowMapType]||`SHADOWMAP_TYPE_BASIC`}var U_={302:`ENVMAP_MODE_REFRACTION`};function W_(e){return e.envMap===!1?`ENVMAP_MODE_REFLECTION`:U_[e.envMapMode]||`ENVMAP_MODE_REFLECTION`}var G_={0:`ENVMAP_BLENDING_MULTIPLY`,1:`ENVMAP_BLENDING_MIX`,2:`ENVMAP_BLENDING_ADD`};function K_(e){return e.envMap===!1?`ENVMAP_BLENDING_NONE`:G_[e.combine]||`ENVMAP_BLENDING_NONE`}function q_(e,t,n,r){let i=e.getContext(),a=n.defines,o=n.vertexShader,s=n.fragmentShader,c=H_(n),l=n.envMapPMREM===!0?`ENVMAP_TYPE_PMREM`:`ENVMAP_TYPE_CUBE`,u=W_(n),d=K_(n),f=O_(n),p=k_(a),m=i.createProgram(),h,g,_=n.glslVersion?`#version `+n.glslVersion+`
`:``;n.isRawShaderMaterial?(h=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(j_).join(`
`),h.length>0&&(h+=`
`),g=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(j_).join(`
`),g.length>0&&(g+=`
`)):(h=[B_(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.extensionClipCullDistance?`#define USE_CLIP_DISTANCE`:``,n.batching?`#define USE_BATCHING`:``,n.batchingColor?`#define USE_BATCHING_COLOR`:``,n.instancing?`#define USE_INSTANCING`:``,n.instancingColor?`#define USE_INSTANCING_COLOR`:``,n.instancingMorph?`#define USE_INSTANCING_MORPH`:``,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.map?`#define USE_MAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+u:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.displacementMap?`#define USE_DISPLACEMENTMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.mapUv?`#define MAP_UV `+n.mapUv:``,n.alphaMapUv?`#define ALPHAMAP_UV `+n.alphaMapUv:``,n.lightMapUv?`#define LIGHTMAP_UV `+n.lightMapUv:``,n.aoMapUv?`#define AOMAP_UV `+n.aoMapUv:``,n.emissiveMapUv?`#define EMISSIVEMAP_UV `+n.emissiveMapUv:``,n.bumpMapUv?`#define BUMPMAP_UV `+n.bumpMapUv:``,n.normalMapUv?`#define NORMALMAP_UV `+n.normalMapUv:``,n.displacementMapUv?`#define DISPLACEMENTMAP_UV `+n.displacementMapUv:``,n.metalnessMapUv?`#define METALNESSMAP_UV `+n.metalnessMapUv:``,n.roughnessMapUv?`#define ROUGHNESSMAP_UV `+n.roughnessMapUv:``,n.anisotropyMapUv?`#define ANISOTROPYMAP_UV `+n.anisotropyMapUv:``,n.clearcoatMapUv?`#define CLEARCOATMAP_UV `+n.clearcoatMapUv:``,n.clearcoatNormalMapUv?`#define CLEARCOAT_NORMALMAP_UV `+n.clearcoatNormalMapUv:``,n.clearcoatRoughnessMapUv?`#define CLEARCOAT_ROUGHNESSMAP_UV `+n.clearcoatRoughnessMapUv:``,n.diffuseRoughnessMapUv?`#define DIFFUSE_ROUGHNESSMAP_UV `+n.diffuseRoughnessMapUv:``,n.iridescenceMapUv?`#define IRIDESCENCEMAP_UV `+n.iridescenceMapUv:``,n.iridescenceThicknessMapUv?`#define IRIDESCENCE_THICKNESSMAP_UV `+n.iridescenceThicknessMapUv:``,n.sheenColorMapUv?`#define SHEEN_COLORMAP_UV `+n.sheenColorMapUv:``,n.sheenRoughnessMapUv?`#define SHEEN_ROUGHNESSMAP_UV `+n.sheenRoughnessMapUv:``,n.specularMapUv?`#define SPECULARMAP_UV `+n.specularMapUv:``,n.specularColorMapUv?`#define SPECULAR_COLORMAP_UV `+n.specularColorMapUv:``,n.specularIntensityMapUv?`#define SPECULAR_INTENSITYMAP_UV `+n.specularIntensityMapUv:``,n.transmissionMapUv?`#define TRANSMISSIONMAP_UV `+n.transmissionMapUv:``,n.thicknessMapUv?`#define THICKNESSMAP_UV `+n.thicknessMapUv:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexNormals?`#define HAS_NORMAL`:``,n.vertexColors?`#define USE_COLOR`:``,n.vertexAlphas?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.flatShading?`#define FLAT_SHADED`:``,n.skinning?`#define USE_SKINNING`:``,n.morphTargets?`#define USE_MORPHTARGETS`:``,n.morphNormals&&n.flatShading===!1?`#define USE_MORPHNORMALS`:``,n.morphColors?`#define USE_MORPHCOLORS`:``,n.morphTargetsCount>0?`#define MORPHTARGETS_TEXTURE_STRIDE `+n.morphTextureStride:``,n.morphTargetsCount>0?`#define MORPHTARGETS_COUNT `+n.morphTargetsCount:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.sizeAttenuation?`#define USE_SIZEATTENUATION`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 modelMatrix;`,`uniform mat4 modelViewMatrix;`,`uniform mat4 projectionMatrix;`,`uniform mat4 viewMatrix;`,`uniform mat3 normalMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,`#ifdef USE_INSTANCING`,`	attribute mat4 instanceMatrix;`,`#endif`,`#ifdef USE_INSTANCING_COLOR`,`	attribute vec3 instanceColor;`,`#endif`,`#ifdef USE_INSTANCING_MORPH`,`	uniform sampler2D morphTexture;`,`#endif`,`attribute vec3 position;`,`attribute vec3 normal;`,`attribute vec2 uv;`,`#ifdef USE_UV1`,`	attribute vec2 uv1;`,`#endif`,`#ifdef USE_UV2`,`	attribute vec2 uv2;`,`#endif`,`#ifdef USE_UV3`,`	attribute vec2 uv3;`,`#endif`,`#ifdef USE_TANGENT`,`	attribute vec4 tangent;`,`#endif`,`#if defined( USE_COLOR_ALPHA )`,`	attribute vec4 color;`,`#elif defined( USE_COLOR )`,`	attribute vec3 color;`,`#endif`,`#ifdef USE_SKINNING`,`	attribute vec4 skinIndex;`,`	attribute vec4 skinWeight;`,`#endif`,`
`].filter(j_).join(`
`),g=[B_(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.alphaToCoverage?`#define ALPHA_TO_COVERAGE`:``,n.map?`#define USE_MAP`:``,n.matcap?`#define USE_MATCAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+l:``,n.envMap?`#define `+u:``,n.envMap?`#define `+d:``,n.envMapPMREM?`#define ENVMAP_MAX_LOD `+n.envMapMaxLod+`.0`:``,n.envMapPMREM?`#define ENVMAP_SIZE `+n.envMapSize+`.0`:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.packedNormalMap?`#define USE_PACKED_NORMALMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoat?`#define USE_CLEARCOAT`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughness?`#define USE_DIFFUSE_ROUGHNESS`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.dispersion?`#define USE_DISPERSION`:``,n.retroreflection?`#define USE_RETROREFLECTION`:``,n.iridescence?`#define USE_IRIDESCENCE`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaTest?`#define USE_ALPHATEST`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.sheen?`#define USE_SHEEN`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexColors||n.instancingColor?`#define USE_COLOR`:``,n.vertexAlphas||n.batchingColor?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.gradientMap?`#define USE_GRADIENTMAP`:``,n.flatShading?`#define FLAT_SHADED`:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.premultipliedAlpha?`#define PREMULTIPLIED_ALPHA`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.decodeVideoTexture?`#define DECODE_VIDEO_TEXTURE`:``,n.decodeVideoTextureEmissive?`#define DECODE_VIDEO_TEXTURE_EMISSIVE`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 viewMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,n.toneMapping===0?``:`#define TONE_MAPPING`,n.toneMapping===0?``:Q.tonemapping_pars_fragment,n.toneMapping===0?``:T_(`toneMapping`,n.toneMapping),n.dithering?`#define DITHERING`:``,n.opaque?`#define OPAQUE`:``,Q.colorspace_pars_fragment,C_(`linearToOutputTexel`,n.outputColorSpace),D_(),n.useDepthPacking?`#define DEPTH_PACKING `+n.depthPacking:``,`
`].filter(j_).join(`
`)),o=F_(o),o=M_(o,n),o=N_(o,n),s=F_(s),s=M_(s,n),s=N_(s,n),o=R_(o),s=R_(s),n.isRawShaderMaterial!==!0&&(_=`#version 300 es
`,h=[f,`#define attribute in`,`#define varying out`,`#define texture2D texture`].join(`
`)+`
`+h,g=[`#define varying in`,n.glslVersion===`300 es`?``:`layout(location = 0) out highp vec4 pc_fragColor;`,n.glslVersion===`300 es`?``:`#define gl_FragColor pc_fragColor`,`#define gl_FragDepthEXT gl_FragDepth`,`#define texture2D texture`,`#define textureCube texture`,`#define texture2DProj textureProj`,`#define texture2DLodEXT textureLod`,`#define texture2DProjLodEXT textureProjLod`,`#define textureCubeLodEXT textureLod`,`#define texture2DGradEXT textureGrad`,`#define texture2DProjGradEXT textureProjGrad`,`#define textureCubeGradEXT textureGrad`].join(`
`)+`
`+g);let v=_+h+o,y=_+g+s,b=g_(i,i.VERTEX_SHADER,v),x=g_(i,i.FRAGMENT_SHADER,y);i.attachShader(m,b),i.attachShader(m,x),n.index0AttributeName===void 0?n.hasPositionAttribute===!0&&i.bindAttribLocation(m,0,`position`):i.bindAttribLocation(m,0,n.index0AttributeName),i.linkProgram(m);function S(t){if(e.debug.checkShaderErrors){let n=i.getProgramInfoLog(m)||``,r=i.getShaderInfoLog(b)||``,a=i.getShaderInfoLog(x)||``,o=n.trim(),s=r.trim(),c=a.trim(),l=!0,u=!0;if(i.getProgramParameter(m,i.LINK_STATUS)===!1){if(l=!1,typeof e.debug.onShaderError==`function`)e.debug.onShaderError(i,m,b,x);else{let e=S_(i,b,`vertex`),n=S_(i,x,`fragment`);q(`WebGLProgram: Shader Error `+i.getError()+` - VALIDATE_STATUS `+i.getProgramParameter(m,i.VALIDATE_STATUS)+`

Material Name: `+t.name+`
Material Type: `+t.type+`

Program Info Log: `+o+`
`+e+`
`+n)}}else o===``?(s===``||c===``)&&(u=!1):K(`WebGLProgram: Program Info Log:`,o);u&&(t.diagnostics={runnable:l,programLog:o,vertexShader:{log:s,prefix:h},fragmentShader:{log:c,prefix:g}})}i.deleteShader(b),i.deleteShader(x),C=new h_(i,m),w=A_(i,m)}let C;this.getUniforms=function(){return C===void 0&&S(this),C};let w;this.getAttributes=function(){return w===void 0&&S(this),w};let T=n.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return T===!1&&(T=i.getProgramParameter(m,__)),T},this.destroy=function(){r.releaseStatesOfProgram(this),i.deleteProgram(m),this.program=void 0},this.type=n.shaderType,this.name=n.shaderName,this.id=v_++,this.cacheKey=t,this.usedTimes=1,this.program=m,this.vertexShader=b,this.fragmentShader=x,this}var J_=0,Y_=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let r=this._getShaderCacheForMaterial(e);return r.has(t)===!1&&(r.add(t),t.usedTimes++),r.has(n)===!1&&(r.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let e of t)e.usedTimes--,e.usedTimes===0&&this.shaderCache.delete(e.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new X_(e),t.set(e,n)),n}},X_=class{constructor(e){this.id=J_++,this.code=e,this.usedTimes=0}};function Z_(e){return e===1030||e===37490||e===36285}function Q_(e,t,n,r,i,a){let o=new $d,s=new Y_,c=new Set,l=[],u=new Map,d=r.logarithmicDepthBuffer,f={MeshDepthMaterial:`depth`,MeshDistanceMaterial:`distance`,MeshNormalMaterial:`normal`,MeshBasicMaterial:`basic`,MeshLambertMaterial:`lambert`,MeshPhongMaterial:`phong`,MeshToonMaterial:`toon`,MeshStandardMaterial:`physical`,MeshPhysicalMaterial:`physical`,MeshMatcapMaterial:`matcap`,LineBasicMaterial:`basic`,LineDashedMaterial:`dashed`,PointsMaterial:`points`,ShadowMaterial:`shadow`,SpriteMaterial:`sprite`};function p(e){return c.add(e),e===0?`uv`:`uv${e}`}function m(i,o,l,u,m,h){let g=u.fog,_=m.geometry,v=i.isMeshStandardMaterial||i.isMeshLambertMaterial||i.isMeshPhongMaterial?u.environment:null,y=i.isMeshStandardMaterial||i.isMeshLambertMaterial&&!i.envMap||i.isMeshPhongMaterial&&!i.envMap,b=t.get(i.envMap||v,y),x=f[i.type],S=r.precision;i.precision!==null&&(S=r.getMaxPrecision(i.precision),S!==i.precision&&K(`WebGLProgram.getParameters:`,i.precision,`not supported, using`,S,`instead.`));let C=_.morphAttributes.position||_.morphAttributes.normal||_.morphAttributes.color,w=C===void 0?0:C.length,T=0;_.morphAttributes.position!==void 0&&(T=1),_.morphAttributes.normal!==void 0&&(T=2),_.morphAttributes.color!==void 0&&(T=3);let E,D,O,k;if(x){let e=Eh[x];E=e.vertexShader,D=e.fragmentShader}else{E=i.vertexShader,D=i.fragmentShader;let e=s.getVertexShaderStage(i),t=s.getFragmentShaderStage(i);s.update(i,e,t),O=e.id,k=t.id}let A=e.getRenderTarget(),j=e.state.buffers.depth.getReversed(),ee=m.isInstancedMesh===!0,M=m.isBatchedMesh===!0,te=!!i.map,ne=!!i.matcap,N=!!b,re=N&&b.isPMREMTexture===!0,ie=!!i.aoMap,ae=!!i.lightMap,oe=!!i.bumpMap&&i.wireframe===!1,se=!!i.normalMap,ce=!!i.displacementMap,le=!!i.emissiveMap,ue=!!i.metalnessMap,de=!!i.roughnessMap,fe=i.anisotropy>0,pe=i.clearcoat>0,me=i.diffuseRoughness>0,he=i.dispersion>0,ge=i.retroreflectivity>0,_e=i.iridescence>0,ve=i.sheen>0,ye=i.transmission>0,be=fe&&!!i.anisotropyMap,xe=pe&&!!i.clearcoatMap,Se=pe&&!!i.clearcoatNormalMap,Ce=pe&&!!i.clearcoatRoughnessMap,we=me&&!!i.diffuseRoughnessMap,P=_e&&!!i.iridescenceMap,Te=_e&&!!i.iridescenceThicknessMap,Ee=ve&&!!i.sheenColorMap,De=ve&&!!i.sheenRoughnessMap,F=!!i.specularMap,I=!!i.specularColorMap,L=!!i.specularIntensityMap,R=ye&&!!i.transmissionMap,Oe=ye&&!!i.thicknessMap,ke=!!i.gradientMap,Ae=!!i.alphaMap,je=i.alphaTest>0,Me=!!i.alphaHash,Ne=!!i.extensions,Pe=0;i.toneMapped&&(A===null||A.isXRRenderTarget===!0)&&(Pe=e.toneMapping);let Fe=re?b.isCompressedCubeTexture?b.image[0].mipmaps:b.mipmaps:null,Ie={shaderID:x,shaderType:i.type,shaderName:i.name,vertexShader:E,fragmentShader:D,defines:i.defines,customVertexShaderID:O,customFragmentShaderID:k,isRawShaderMaterial:i.isRawShaderMaterial===!0,glslVersion:i.glslVersion,precision:S,batching:M,batchingColor:M&&m._colorsTexture!==null,instancing:ee,instancingColor:ee&&m.instanceColor!==null,instancingMorph:ee&&m.morphTexture!==null,outputColorSpace:A===null?e.outputColorSpace:A.isXRRenderTarget===!0?A.texture.colorSpace:Ed.workingColorSpace,alphaToCoverage:!!i.alphaToCoverage,map:te,matcap:ne,envMap:N,envMapMode:N&&b.mapping,envMapPMREM:re,envMapMaxLod:re?Fe.length-1:null,envMapSize:re?Fe[0].width:null,aoMap:ie,lightMap:ae,bumpMap:oe,normalMap:se,displacementMap:ce,emissiveMap:le,normalMapObjectSpace:se&&i.normalMapType===1,normalMapTangentSpace:se&&i.normalMapType===0,packedNormalMap:se&&i.normalMapType===0&&Z_(i.normalMap.format),metalnessMap:ue,roughnessMap:de,anisotropy:fe,anisotropyMap:be,clearcoat:pe,clearcoatMap:xe,clearcoatNormalMap:Se,clearcoatRoughnessMap:Ce,diffuseRoughness:me,diffuseRoughnessMap:we,dispersion:he,retroreflection:ge,iridescence:_e,iridescenceMap:P,iridescenceThicknessMap:Te,sheen:ve,sheenColorMap:Ee,sheenRoughnessMap:De,specularMap:F,specularColorMap:I,specularIntensityMap:L,transmission:ye,transmissionMap:R,thicknessMap:Oe,gradientMap:ke,opaque:i.transparent===!1&&i.blending===1&&i.alphaToCoverage===!1,alphaMap:Ae,alphaTest:je,alphaHash:Me,combine:i.combine,mapUv:te&&p(i.map.channel),aoMapUv:ie&&p(i.aoMap.channel),lightMapUv:ae&&p(i.lightMap.channel),bumpMapUv:oe&&p(i.bumpMap.channel),normalMapUv:se&&p(i.normalMap.channel),displacementMapUv:ce&&p(i.displacementMap.channel),emissiveMapUv:le&&p(i.emissiveMap.channel),metalnessMapUv:ue&&p(i.metalnessMap.channel),roughnessMapUv:de&&p(i.roughnessMap.channel),anisotropyMapUv:be&&p(i.anisotropyMap.channel),clearcoatMapUv:xe&&p(i.clearcoatMap.channel),clearcoatNormalMapUv:Se&&p(i.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:Ce&&p(i.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:we&&p(i.diffuseRoughnessMap.channel),iridescenceMapUv:P&&p(i.iridescenceMap.channel),iridescenceThicknessMapUv:Te&&p(i.iridescenceThicknessMap.channel),sheenColorMapUv:Ee&&p(i.sheenColorMap.channel),sheenRoughnessMapUv:De&&p(i.sheenRoughnessMap.channel),specularMapUv:F&&p(i.specularMap.channel),specularColorMapUv:I&&p(i.specularColorMap.channel),specularIntensityMapUv:L&&p(i.specularIntensityMap.channel),transmissionMapUv:R&&p(i.transmissionMap.channel),thicknessMapUv:Oe&&p(i.thicknessMap.channel),alphaMapUv:Ae&&p(i.alphaMap.channel),vertexTangents:!!_.attributes.tangent&&(se||fe),vertexNormals:!!_.attributes.normal,vertexColors:i.vertexColors,vertexAlphas:i.vertexColors===!0&&!!_.attributes.color&&_.attributes.color.itemSize===4,pointsUvs:m.isPoints===!0&&!!_.attributes.uv&&(te||Ae),fog:!!g,useFog:i.fog===!0,fogExp2:!!g&&g.isFogExp2,flatShading:i.wireframe===!1&&(i.flatShading===!0||_.attributes.normal===void 0&&se===!1&&(i.isMeshLambertMaterial||i.isMeshPhongMaterial||i.isMeshStandardMaterial||i.isMeshPhysicalMaterial)),sizeAttenuation:i.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:j,skinning:m.isSkinnedMesh===!0,hasPositionAttribute:_.attributes.position!==void 0,morphTargets:_.morphAttributes.position!==void 0,morphNormals:_.morphAttributes.normal!==void 0,morphColors:_.morphAttributes.color!==void 0,morphTargetsCount:w,morphTextureStride:T,numSunLights:o.sun.length,numDirLights:o.directional.length,numPointLights:o.point.length,numSpotLights:o.spot.length,numSpotLightMaps:o.spotLightMap.length,numRectAreaLights:o.rectArea.length,numHemiLights:o.hemi.length,numSunLightShadows:o.sunShadowMap.length,numDirLightShadows:o.directionalShadowMap.length,numPointLightShadows:o.pointShadowMap.length,numSpotLightShadows:o.spotShadowMap.length,numSpotLightShadowsWithMaps:o.numSpotLightShadowsWithMaps,numLightProbes:o.numLightProbes,numLightProbeGrids:h.filter(e=>e.texture!==null).length,numClippingPlanes:a.numPlanes,numClipIntersection:a.numIntersection,dithering:i.dithering,shadowMapEnabled:e.shadowMap.enabled&&l.length>0,shadowMapType:e.shadowMap.type,toneMapping:Pe,decodeVideoTexture:te&&i.map.isVideoTexture===!0&&Ed.getTransfer(i.map.colorSpace)===`srgb`,decodeVideoTextureEmissive:le&&i.emissiveMap.isVideoTexture===!0&&Ed.getTransfer(i.emissiveMap.colorSpace)===`srgb`,premultipliedAlpha:i.premultipliedAlpha,doubleSided:i.side===2,flipSided:i.side===1,useDepthPacking:i.depthPacking>=0,depthPacking:i.depthPacking||0,index0AttributeName:i.index0AttributeName,extensionClipCullDistance:Ne&&i.extensions.clipCullDistance===!0&&n.has(`WEBGL_clip_cull_distance`),extensionMultiDraw:(Ne&&i.extensions.multiDraw===!0||M)&&n.has(`WEBGL_multi_draw`),rendererExtensionParallelShaderCompile:n.has(`KHR_parallel_shader_compile`),customProgramCacheKey:i.customProgramCacheKey()};return Ie.vertexUv1s=c.has(1),Ie.vertexUv2s=c.has(2),Ie.vertexUv3s=c.has(3),c.clear(),Ie}function h(t){let n=[];if(t.shaderID?n.push(t.shaderID):(n.push(t.customVertexShaderID),n.push(t.customFragmentShaderID)),t.defines!==void 0)for(let e in t.defines)n.push(e),n.push(t.defines[e]);return t.isRawShaderMaterial===!1&&(g(n,t),_(n,t),n.push(e.outputColorSpace)),n.push(t.customProgramCacheKey),n.join()}function g(e,t){e.push(t.precision),e.push(t.outputColorSpace),e.push(t.envMapMode),e.push(t.envMapPMREM),e.push(t.envMapMaxLod),e.push(t.envMapSize),e.push(t.mapUv),e.push(t.alphaMapUv),e.push(t.lightMapUv),e.push(t.aoMapUv),e.push(t.bumpMapUv),e.push(t.normalMapUv),e.push(t.displacementMapUv),e.push(t.emissiveMapUv),e.push(t.metalnessMapUv),e.push(t.roughnessMapUv),e.push(t.anisotropyMapUv),e.push(t.clearcoatMapUv),e.push(t.clearcoatNormalMapUv),e.push(t.clearcoatRoughnessMapUv),e.push(t.diffuseRoughnessMapUv),e.push(t.iridescenceMapUv),e.push(t.iridescenceThicknessMapUv),e.push(t.sheenColorMapUv),e.push(t.sheenRoughnessMapUv),e.push(t.specularMapUv),e.push(t.specularColorMapUv),e.push(t.specularIntensityMapUv),e.push(t.transmissionMapUv),e.push(t.thicknessMapUv),e.push(t.combine),e.push(t.fogExp2),e.push(t.sizeAttenuation),e.push(t.morphTargetsCount),e.push(t.numSunLights),e.push(t.numDirLights),e.push(t.numPointLights),e.push(t.numSpotLights),e.push(t.numSpotLightMaps),e.push(t.numHemiLights),e.push(t.numRectAreaLights),e.push(t.numSunLightShadows),e.push(t.numDirLightShadows),e.push(t.numPointLightShadows),e.push(t.numSpotLightShadows),e.push(t.numSpotLightShadowsWithMaps),e.push(t.numLightProbes),e.push(t.numLightProbeGrids),e.push(t.shadowMapType),e.push(t.toneMapping),e.push(t.numClippingPlanes),e.push(t.numClipIntersection),e.push(t.depthPacking)}function _(e,t){o.disableAll(),t.instancing&&o.enable(0),t.instancingColor&&o.enable(1),t.instancingMorph&&o.enable(2),t.matcap&&o.enable(3),t.envMap&&o.enable(4),t.normalMapObjectSpace&&o.enable(5),t.normalMapTangentSpace&&o.enable(6),t.clearcoat&&o.enable(7),t.iridescence&&o.enable(8),t.alphaTest&&o.enable(9),t.vertexColors&&o.enable(10),t.vertexAlphas&&o.enable(11),t.vertexUv1s&&o.enable(12),t.vertexUv2s&&o.enable(13),t.vertexUv3s&&o.enable(14),t.vertexTangents&&o.enable(15),t.anisotropy&&o.enable(16),t.alphaHash&&o.enable(17),t.batching&&o.enable(18),t.dispersion&&o.enable(19),t.retroreflection&&o.enable(24),t.diffuseRoughness&&o.enable(25),t.batchingColor&&o.enable(20),t.gradientMap&&o.enable(21),t.packedNormalMap&&o.enable(22),t.vertexNormals&&o.enable(23),e.push(o.mask),o.disableAll(),t.fog&&o.enable(0),t.useFog&&o.enable(1),t.flatShading&&o.enable(2),t.logarithmicDepthBuffer&&o.enable(3),t.reversedDepthBuffer&&o.enable(4),t.skinning&&o.enable(5),t.morphTargets&&o.enable(6),t.morphNormals&&o.enable(7),t.morphColors&&o.enable(8),t.premultipliedAlpha&&o.enable(9),t.shadowMapEnabled&&o.enable(10),t.doubleSided&&o.enable(11),t.flipSided&&o.enable(12),t.useDepthPacking&&o.enable(13),t.dithering&&o.enable(14),t.transmission&&o.enable(15),t.sheen&&o.enable(16),t.opaque&&o.enable(17),t.pointsUvs&&o.enable(18),t.decodeVideoTexture&&o.enable(19),t.decodeVideoTextureEmissive&&o.enable(20),t.alphaToCoverage&&o.enable(21),t.numLightProbeGrids>0&&o.enable(22),t.hasPositionAttribute&&o.enable(23),e.push(o.mask)}function v(e){let t=f[e.type],n;if(t){let e=Eh[t];n=Sm.clone(e.uniforms)}else n=e.uniforms;return n}function y(t,n){let r=u.get(n);return r===void 0?(r=new q_(e,n,t,i),l.push(r),u.set(n,r)):++r.usedTimes,r}function b(e){if(--e.usedTimes===0){let t=l.indexOf(e);l[t]=l[l.length-1],l.pop(),u.delete(e.cacheKey),e.destroy()}}function x(e){s.remove(e)}function S(){s.dispose()}return{getParameters:m,getProgramCacheKey:h,getUniforms:v,acquireProgram:y,releaseProgram:b,releaseShaderCache:x,programs:l,dispose:S}}function $_(){let e=new WeakMap;function t(t){return e.has(t)}function n(t){let n=e.get(t);return n===void 0&&(n={},e.set(t,n)),n}function r(t){e.delete(t)}function i(t,n,r){e.get(t)[n]=r}function a(){e=new WeakMap}return{has:t,get:n,remove:r,update:i,dispose:a}}function ev(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.material.id===t.material.id?e.materialVariant===t.materialVariant?e.z===t.z?e.id-t.id:e.z-t.z:e.materialVariant-t.materialVariant:e.material.id-t.material.id:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function tv(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.z===t.z?e.id-t.id:t.z-e.z:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function nv(){let e=[],t=0,n=[],r=[],i=[];function a(){t=0,n.length=0,r.length=0,i.length=0}function o(e){let t=0;return e.isInstancedMesh&&(t+=2),e.isSkinnedMesh&&(t+=1),t}function s(n,r,i,a,s,c){let l=e[t];return l===void 0?(l={id:n.id,object:n,geometry:r,material:i,materialVariant:o(n),groupOrder:a,renderOrder:n.renderOrder,z:s,group:c},e[t]=l):(l.id=n.id,l.object=n,l.geometry=r,l.material=i,l.materialVariant=o(n),l.groupOrder=a,l.renderOrder=n.renderOrder,l.z=s,l.group=c),t++,l}function c(e,t,a,o,c,l,u){u.reversedDepth===!0&&(c=-c);let d=s(e,t,a,o,c,l);a.transmission>0?r.push(d):a.transparent===!0?i.push(d):n.push(d)}function l(e,t,a,o,c,l){let u=s(e,t,a,o,c,l);a.transmission>0?r.unshift(u):a.transparent===!0?i.unshift(u):n.unshift(u)}function u(e,t){n.length>1&&n.sort(e||ev),r.length>1&&r.sort(t||tv),i.length>1&&i.sort(t||tv)}function d(){for(let n=t,r=e.length;n<r;n++){let t=e[n];if(t.id===null)break;t.id=null,t.object=null,t.geometry=null,t.material=null,t.group=null}}return{opaque:n,transmissive:r,transparent:i,init:a,push:c,unshift:l,finish:d,sort:u}}function rv(){let e=new WeakMap;function t(t,n){let r=e.get(t),i;return r===void 0?(i=new nv,e.set(t,[i])):n>=r.length?(i=new nv,r.push(i)):i=r[n],i}function n(){e=new WeakMap}return{get:t,dispose:n}}function iv(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={direction:new X,color:new wf};break;case`SpotLight`:n={position:new X,direction:new X,color:new wf,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case`PointLight`:n={position:new X,color:new wf,distance:0,decay:0};break;case`HemisphereLight`:n={direction:new X,skyColor:new wf,groundColor:new wf};break;case`RectAreaLight`:n={color:new wf,position:new X,halfWidth:new X,halfHeight:new X}}return e[t.id]=n,n}}}function av(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Y};break;case`SpotLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Y};break;case`PointLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Y,shadowCameraNear:1,shadowCameraFar:1e3}}return e[t.id]=n,n}}}var ov=0;function sv(e,t){return(t.castShadow?2:0)-(e.castShadow?2:0)+ +!!t.map-!!e.map}function cv(e){let t=new iv,n=av(),r={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let e=0;e<9;e++)r.probe.push(new X);let i=new X,a=new Hd,o=new Hd;function s(i){let a=0,o=0,s=0;for(let e=0;e<9;e++)r.probe[e].set(0,0,0);let c=0,l=0,u=0,d=0,f=0,p=0,m=0,h=0,g=0,_=0,v=0,y=0,b=0,x=0;i.sort(sv);for(let e=0,S=i.length;e<S;e++){let S=i[e],C=S.color,w=S.intensity,T=S.distance,E=null;if(S.shadow&&S.shadow.map&&(E=S.shadow.map.texture.format===1030?S.shadow.map.texture:S.shadow.map.depthTexture||S.shadow.map.texture),S.isAmbientLight)a+=C.r*w,o+=C.g*w,s+=C.b*w;else if(S.isLightProbe){for(let e=0;e<9;e++)r.probe[e].addScaledVector(S.sh.coefficients[e],w);x++}else if(S.isSunLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize.copy(e.mapSize).multiply(e.getFrameExtents()),r.sunShadow[l]=t,r.sunShadowMap[l]=E;let i=e.getViewportCount();for(let t=0;t<i;t++)r.sunShadowMatrix[u+t]=e.getMatrix(t),r.sunShadowCascade[u+t]=e._cascadeData[t];u+=i,l++}r.sun[c]=e,c++}else if(S.isDirectionalLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,r.directionalShadow[d]=t,r.directionalShadowMap[d]=E,r.directionalShadowMatrix[d]=S.shadow.matrix,g++}r.directional[d]=e,d++}else if(S.isSpotLight){let e=t.get(S);e.position.setFromMatrixPosition(S.matrixWorld),e.color.copy(C).multiplyScalar(w),e.distance=T,e.coneCos=Math.cos(S.angle),e.penumbraCos=Math.cos(S.angle*(1-S.penumbra)),e.decay=S.decay,r.spot[p]=e;let i=S.shadow;if(S.map&&(r.spotLightMap[y]=S.map,y++,i.updateMatrices(S),S.castShadow&&b++),r.spotLightMatrix[p]=i.matrix,S.castShadow){let e=n.get(S);e.shadowIntensity=i.intensity,e.shadowBias=i.bias,e.shadowNormalBias=i.normalBias,e.shadowRadius=i.radius,e.shadowMapSize=i.mapSize,r.spotShadow[p]=e,r.spotShadowMap[p]=E,v++}p++}else if(S.isRectAreaLight){let e=t.get(S);e.color.copy(C).multiplyScalar(w),e.halfWidth.set(S.width*.5,0,0),e.halfHeight.set(0,S.height*.5,0),r.rectArea[m]=e,m++}else if(S.isPointLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),e.distance=S.distance,e.decay=S.decay,S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,t.shadowCameraNear=e.camera.near,t.shadowCameraFar=e.camera.far,r.pointShadow[f]=t,r.pointShadowMap[f]=E,r.pointShadowMatrix[f]=S.shadow.matrix,_++}r.point[f]=e,f++}else if(S.isHemisphereLight){let e=t.get(S);e.skyColor.copy(S.color).multiplyScalar(w),e.groundColor.copy(S.groundColor).multiplyScalar(w),r.hemi[h]=e,h++}}m>0&&(e.has(`OES_texture_float_linear`)===!0?(r.rectAreaLTC1=$.LTC_FLOAT_1,r.rectAreaLTC2=$.LTC_FLOAT_2):(r.rectAreaLTC1=$.LTC_HALF_1,r.rectAreaLTC2=$.LTC_HALF_2)),r.ambient[0]=a,r.ambient[1]=o,r.ambient[2]=s;let S=r.hash;(S.sunLength!==c||S.directionalLength!==d||S.pointLength!==f||S.spotLength!==p||S.rectAreaLength!==m||S.hemiLength!==h||S.numSunShadows!==l||S.numDirectionalShadows!==g||S.numPointShadows!==_||S.numSpotShadows!==v||S.numSpotMaps!==y||S.numLightProbes!==x)&&(r.sun.length=c,r.directional.length=d,r.spot.length=p,r.rectArea.length=m,r.point.length=f,r.hemi.length=h,r.sunShadow.length=l,r.sunShadowMap.length=l,r.sunShadowMatrix.length=u,r.sunShadowCascade.length=u,r.directionalShadow.length=g,r.directionalShadowMap.length=g,r.directionalShadowMatrix.length=g,r.pointShadow.length=_,r.pointShadowMap.length=_,r.pointShadowMatrix.length=_,r.spotShadow.length=v,r.spotShadowMap.length=v,r.spotLightMatrix.length=v+y-b,r.spotLightMap.length=y,r.numSpotLightShadowsWithMaps=b,r.numLightProbes=x,S.sunLength=c,S.directionalLength=d,S.pointLength=f,S.spotLength=p,S.rectAreaLength=m,S.hemiLength=h,S.numSunShadows=l,S.numDirectionalShadows=g,S.numPointShadows=_,S.numSpotShadows=v,S.numSpotMaps=y,S.numLightProbes=x,r.version=ov++)}function c(e,t){let n=0,s=0,c=0,l=0,u=0,d=0,f=t.matrixWorldInverse;for(let t=0,p=e.length;t<p;t++){let p=e[t];if(p.isSunLight){let e=r.sun[n];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),n++}else if(p.isDirectionalLight){let e=r.directional[s];e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),s++}else if(p.isSpotLight){let e=r.spot[l];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),l++}else if(p.isRectAreaLight){let e=r.rectArea[u];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),o.identity(),a.copy(p.matrixWorld),a.premultiply(f),o.extractRotation(a),e.halfWidth.set(p.width*.5,0,0),e.halfHeight.set(0,p.height*.5,0),e.halfWidth.applyMatrix4(o),e.halfHeight.applyMatrix4(o),u++}else if(p.isPointLight){let e=r.point[c];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),c++}else if(p.isHemisphereLight){let e=r.hemi[d];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),d++}}}return{setup:s,setupView:c,state:r}}function lv(e){let t=new cv(e),n=[],r=[],i=[];function a(e){u.camera=e,n.length=0,r.length=0,i.length=0}function o(e){e.isLightProbeGrid?i.push(e):n.push(e)}function s(e){r.push(e)}function c(){t.setup(n),i.sort((e,t)=>e.priority-t.priority||e.id-t.id)}function l(e){t.setupView(n,e)}let u={lightsArray:n,shadowsArray:r,lightProbeGridArray:i,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:a,state:u,setupLights:c,setupLightsView:l,pushLight:o,pushShadow:s}}function uv(e){let t=new WeakMap;function n(n,r=0){let i=t.get(n),a;return i===void 0?(a=new lv(e),t.set(n,[a])):r>=i.length?(a=new lv(e),i.push(a)):a=i[r],a}function r(){t=new WeakMap}return{get:n,dispose:r}}var dv=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,fv=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,pv=[new X(1,0,0),new X(-1,0,0),new X(0,1,0),new X(0,-1,0),new X(0,0,1),new X(0,0,-1)],mv=[new X(0,-1,0),new X(0,-1,0),new X(0,0,1),new X(0,0,-1),new X(0,-1,0),new X(0,-1,0)],hv=new Hd,gv=new X,_v=new X;function vv(e,t,n){let r=new om,i=new Y,a=new Y,o=new Ld,s=new Dm,c=new Om,l={},u=n.maxTextureSize,d={0:1,1:0,2:2},f=new Tm({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new Y},radius:{value:4}},vertexShader:dv,fragmentShader:fv}),p=f.clone();p.defines.HORIZONTAL_PASS=1;let m=new bp;m.setAttribute(`position`,new ap(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let h=new Wp(m,f),g=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=1;let _=this.type;this.render=function(t,n,s){if(g.enabled===!1||g.autoUpdate===!1&&g.needsUpdate===!1||t.length===0)return;this.type===2&&(K(`WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead.`),this.type=1);let c=e.getRenderTarget(),l=e.getActiveCubeFace(),d=e.getActiveMipmapLevel(),f=e.state;f.setBlending(0),f.buffers.depth.getReversed()===!0?f.buffers.color.setClear(0,0,0,0):f.buffers.color.setClear(1,1,1,1),f.buffers.depth.setTest(!0),f.setScissorTest(!1);let p=_!==this.type;p&&n.traverse(function(e){e.material&&(Array.isArray(e.material)?e.material.forEach(e=>e.needsUpdate=!0):e.material.needsUpdate=!0)});for(let c=0,l=t.length;c<l;c++){let l=t[c],d=l.shadow;if(d===void 0){K(`WebGLShadowMap:`,l,`has no shadow.`);continue}if(d.autoUpdate===!1&&d.needsUpdate===!1)continue;i.copy(d.mapSize);let m=d.getFrameExtents();i.multiply(m),a.copy(d.mapSize),(i.x>u||i.y>u)&&(i.x>u&&(a.x=Math.floor(u/m.x),i.x=a.x*m.x,d.mapSize.x=a.x),i.y>u&&(a.y=Math.floor(u/m.y),i.y=a.y*m.y,d.mapSize.y=a.y));let h=e.state.buffers.depth.getReversed();if(d.camera._reversedDepth=h,d.map===null||p===!0){if(d.map!==null&&(d.map.depthTexture!==null&&(d.map.depthTexture.dispose(),d.map.depthTexture=null),d.map.dispose()),this.type===3){if(l.isPointLight){K(`WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.`);continue}d.map=new zd(i.x,i.y,{format:Pl,type:xl,minFilter:dl,magFilter:dl,generateMipmaps:!1}),d.map.texture.name=l.name+`.shadowMap`,d.map.depthTexture=new um(i.x,i.y,bl),d.map.depthTexture.name=l.name+`.shadowMapDepth`,d.map.depthTexture.format=Al,d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=cl,d.map.depthTexture.magFilter=cl}else l.isPointLight?(d.map=new Fh(i.x),d.map.depthTexture=new dm(i.x,yl)):(d.map=new zd(i.x,i.y),d.map.depthTexture=new um(i.x,i.y,yl)),d.map.depthTexture.name=l.name+`.shadowMap`,d.map.depthTexture.format=Al,this.type===1?(d.map.depthTexture.compareFunction=h?518:515,d.map.depthTexture.minFilter=dl,d.map.depthTexture.magFilter=dl):(d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=cl,d.map.depthTexture.magFilter=cl);d.camera.updateProjectionMatrix()}d.map.isWebGLCubeRenderTarget!==!0&&(d.map.width!==i.x||d.map.height!==i.y)&&d.map.setSize(i.x,i.y);let g=d.map.isWebGLCubeRenderTarget?6:d.getViewportCount();l.isPointLight!==!0&&d.updateMatrices(l,s);let _=d.camera.layers.mask&4294967294?d.camera.layers:s.layers;for(let t=0;t<g;t++){let i=d.getCamera(t);if(l.isPointLight){let e=d.camera,n=d.matrix,r=l.distance||e.far;r!==e.far&&(e.far=r,e.updateProjectionMatrix()),gv.setFromMatrixPosition(l.matrixWorld),e.position.copy(gv),_v.copy(e.position),_v.add(pv[t]),e.up.copy(mv[t]),e.lookAt(_v),e.updateMatrixWorld(),n.makeTranslation(-gv.x,-gv.y,-gv.z),hv.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),d._frustum.setFromProjectionMatrix(hv,e.coordinateSystem,e.reversedDepth)}if(d.map.isWebGLCubeRenderTarget)e.setRenderTarget(d.map,t),e.clear();else{t===0&&(e.setRenderTarget(d.map),e.clear());let n=d.getViewport(t);o.set(a.x*n.x,a.y*n.y,a.x*n.z,a.y*n.w),f.viewport(o)}r=d.getFrustum(t),b(n,s,i,l,_,this.type)}d.isPointLightShadow!==!0&&this.type===3&&v(d,s),d.needsUpdate=!1}_=this.type,g.needsUpdate=!1,e.setRenderTarget(c,l,d)};function v(n,r){let a=t.update(h);f.defines.VSM_SAMPLES!==n.blurSamples&&(f.defines.VSM_SAMPLES=n.blurSamples,p.defines.VSM_SAMPLES=n.blurSamples,f.needsUpdate=!0,p.needsUpdate=!0),n.mapPass===null?n.mapPass=new zd(i.x,i.y,{format:Pl,type:xl}):(n.mapPass.width!==n.map.width||n.mapPass.height!==n.map.height)&&n.mapPass.setSize(n.map.width,n.map.height),f.uniforms.shadow_pass.value=n.map.depthTexture,f.uniforms.resolution.value.set(n.map.width,n.map.height),f.uniforms.radius.value=n.radius,e.setRenderTarget(n.mapPass),e.clear(),e.renderBufferDirect(r,null,a,f,h,null),p.uniforms.shadow_pass.value=n.mapPass.texture,p.uniforms.resolution.value.set(n.map.width,n.map.height),p.uniforms.radius.value=n.radius,e.setRenderTarget(n.map),e.clear(),e.renderBufferDirect(r,null,a,p,h,null)}function y(t,n,r,i){let a=null,o=r.isPointLight===!0?t.customDistanceMaterial:t.customDepthMaterial;if(o!==void 0)a=o;else if(a=r.isPointLight===!0?c:s,e.localClippingEnabled&&n.clipShadows===!0&&Array.isArray(n.clippingPlanes)&&n.clippingPlanes.length!==0||n.displacementMap&&n.displacementScale!==0||n.alphaMap&&n.alphaTest>0||n.map&&n.alphaTest>0||n.alphaToCoverage===!0){let e=a.uuid,t=n.uuid,r=l[e];r===void 0&&(r={},l[e]=r);let i=r[t];i===void 0&&(i=a.clone(),r[t]=i,n.addEventListener(`dispose`,x)),a=i}if(a.visible=n.visible,a.wireframe=n.wireframe,i===3?a.side=n.shadowSide===null?n.side:n.shadowSide:a.side=n.shadowSide===null?d[n.side]:n.shadowSide,a.alphaMap=n.alphaMap,a.alphaTest=n.alphaToCoverage===!0?.5:n.alphaTest,a.map=n.map,a.clipShadows=n.clipShadows,a.clippingPlanes=n.clippingPlanes,a.clipIntersection=n.clipIntersection,a.displacementMap=n.displacementMap,a.displacementScale=n.displacementScale,a.displacementBias=n.displacementBias,a.wireframeLinewidth=n.wireframeLinewidth,a.linewidth=n.linewidth,r.isPointLight===!0&&a.isMeshDistanceMaterial===!0){let t=e.properties.get(a);t.light=r}return a}function b(n,i,a,o,s,c){if(n.visible===!1)return;if(n.layers.test(s)&&(n.isMesh||n.isLine||n.isPoints)&&(n.castShadow||n.receiveShadow&&c===3)&&(!n.frustumCulled||n.intersectsFrustum(r))){n.modelViewMatrix.multiplyMatrices(a.matrixWorldInverse,n.matrixWorld);let r=t.update(n),s=n.material;if(Array.isArray(s)){let t=r.groups;for(let l=0,u=t.length;l<u;l++){let u=t[l],d=s[u.materialIndex];if(d&&d.visible){let t=y(n,d,o,c);n.onBeforeShadow(e,n,i,a,r,t,u),e.renderBufferDirect(a,null,r,t,n,u),n.onAfterShadow(e,n,i,a,r,t,u)}}}else if(s.visible){let t=y(n,s,o,c);n.onBeforeShadow(e,n,i,a,r,t,null),e.renderBufferDirect(a,null,r,t,n,null),n.onAfterShadow(e,n,i,a,r,t,null)}}let l=n.children;for(let e=0,t=l.length;e<t;e++)b(l[e],i,a,o,s,c)}function x(e){e.target.removeEventListener(`dispose`,x);for(let t in l){let n=l[t],r=e.target.uuid;r in n&&(n[r].dispose(),delete n[r])}}}function yv(e,t){function n(){let t=!1,n=new Ld,r=null,i=new Ld(0,0,0,0);return{setMask:function(n){r!==n&&!t&&(e.colorMask(n,n,n,n),r=n)},setLocked:function(e){t=e},setClear:function(t,r,a,o,s){s===!0&&(t*=o,r*=o,a*=o),n.set(t,r,a,o),i.equals(n)===!1&&(e.clearColor(t,r,a,o),i.copy(n))},reset:function(){t=!1,r=null,i.set(-1,0,0,0)}}}function r(){let n=!1,r=!1,i=null,a=null,o=null;return{setReversed:function(e){if(r!==e){let n=t.get(`EXT_clip_control`);e?n.clipControlEXT(n.LOWER_LEFT_EXT,n.ZERO_TO_ONE_EXT):n.clipControlEXT(n.LOWER_LEFT_EXT,n.NEGATIVE_ONE_TO_ONE_EXT),r=e;let i=o;o=null,this.setClear(i)}},getReversed:function(){return r},setTest:function(t){t?ue(e.DEPTH_TEST):de(e.DEPTH_TEST)},setMask:function(t){i!==t&&!n&&(e.depthMask(t),i=t)},setFunc:function(t){if(r&&(t=Wu[t]),a!==t){switch(t){case 0:e.depthFunc(e.NEVER);break;case 1:e.depthFunc(e.ALWAYS);break;case 2:e.depthFunc(e.LESS);break;case 3:e.depthFunc(e.LEQUAL);break;case 4:e.depthFunc(e.EQUAL);break;case 5:e.depthFunc(e.GEQUAL);break;case 6:e.depthFunc(e.GREATER);break;case 7:e.depthFunc(e.NOTEQUAL);break;default:e.depthFunc(e.LEQUAL)}a=t}},setLocked:function(e){n=e},setClear:function(t){o!==t&&(o=t,r&&(t=1-t),e.clearDepth(t))},reset:function(){n=!1,i=null,a=null,o=null,r=!1}}}function i(){let t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null;return{setTest:function(n){t||(n?ue(e.STENCIL_TEST):de(e.STENCIL_TEST))},setMask:function(r){n!==r&&!t&&(e.stencilMask(r),n=r)},setFunc:function(t,n,o){(r!==t||i!==n||a!==o)&&(e.stencilFunc(t,n,o),r=t,i=n,a=o)},setOp:function(t,n,r){(o!==t||s!==n||c!==r)&&(e.stencilOp(t,n,r),o=t,s=n,c=r)},setLocked:function(e){t=e},setClear:function(t){l!==t&&(e.clearStencil(t),l=t)},reset:function(){t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null}}}let a=new n,o=new r,s=new i,c={},l=new WeakMap,u={},d={},f={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new wf(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,ee=e.getParameter(e.MAX_COMBINED_TEXTURE_IMAGE_UNITS),M=!1,te=0,ne=e.getParameter(e.VERSION);ne.indexOf(`WebGL`)===-1?ne.indexOf(`OpenGL ES`)!==-1&&(te=parseFloat(/^OpenGL ES (\d)/.exec(ne)[1]),M=te>=2):(te=parseFloat(/^WebGL (\d)/.exec(ne)[1]),M=te>=1);let N=null,re={},ie=e.getParameter(e.SCISSOR_BOX),ae=e.getParameter(e.VIEWPORT),oe=new Ld().fromArray(ie),se=new Ld().fromArray(ae);function ce(t,n,r,i){let a=new Uint8Array(4),o=e.createTexture();e.bindTexture(t,o),e.texParameteri(t,e.TEXTURE_MIN_FILTER,e.NEAREST),e.texParameteri(t,e.TEXTURE_MAG_FILTER,e.NEAREST);for(let o=0;o<r;o++)t===e.TEXTURE_3D||t===e.TEXTURE_2D_ARRAY?e.texImage3D(n,0,e.RGBA,1,1,i,0,e.RGBA,e.UNSIGNED_BYTE,a):e.texImage2D(n+o,0,e.RGBA,1,1,0,e.RGBA,e.UNSIGNED_BYTE,a);return o}let le={};le[e.TEXTURE_2D]=ce(e.TEXTURE_2D,e.TEXTURE_2D,1),le[e.TEXTURE_CUBE_MAP]=ce(e.TEXTURE_CUBE_MAP,e.TEXTURE_CUBE_MAP_POSITIVE_X,6),le[e.TEXTURE_2D_ARRAY]=ce(e.TEXTURE_2D_ARRAY,e.TEXTURE_2D_ARRAY,1,1),le[e.TEXTURE_3D]=ce(e.TEXTURE_3D,e.TEXTURE_3D,1,1),a.setClear(0,0,0,1),o.setClear(1),s.setClear(0),ue(e.DEPTH_TEST),o.setFunc(3),ye(!1),be(1),ue(e.CULL_FACE),_e(0);function ue(t){u[t]!==!0&&(e.enable(t),u[t]=!0)}function de(t){u[t]!==!1&&(e.disable(t),u[t]=!1)}function fe(t,n){return f[t]!==n&&(e.bindFramebuffer(t,n),f[t]=n,t===e.DRAW_FRAMEBUFFER&&(f[e.FRAMEBUFFER]=n),t===e.FRAMEBUFFER&&(f[e.DRAW_FRAMEBUFFER]=n),!0)}function pe(t,n){let r=m,i=!1;if(t){r=p.get(n),r===void 0&&(r=[],p.set(n,r));let a=t.textures;if(r.length!==a.length||r[0]!==e.COLOR_ATTACHMENT0){for(let t=0,n=a.length;t<n;t++)r[t]=e.COLOR_ATTACHMENT0+t;r.length=a.length,i=!0}}else r[0]!==e.BACK&&(r[0]=e.BACK,i=!0);i&&e.drawBuffers(r)}function me(t){return h!==t&&(e.useProgram(t),h=t,!0)}let he={100:e.FUNC_ADD,101:e.FUNC_SUBTRACT,102:e.FUNC_REVERSE_SUBTRACT};he[103]=e.MIN,he[104]=e.MAX;let ge={200:e.ZERO,201:e.ONE,202:e.SRC_COLOR,204:e.SRC_ALPHA,210:e.SRC_ALPHA_SATURATE,208:e.DST_COLOR,206:e.DST_ALPHA,203:e.ONE_MINUS_SRC_COLOR,205:e.ONE_MINUS_SRC_ALPHA,209:e.ONE_MINUS_DST_COLOR,207:e.ONE_MINUS_DST_ALPHA,211:e.CONSTANT_COLOR,212:e.ONE_MINUS_CONSTANT_COLOR,213:e.CONSTANT_ALPHA,214:e.ONE_MINUS_CONSTANT_ALPHA};function _e(t,n,r,i,a,o,s,c,l,u){if(t===0)g===!0&&(de(e.BLEND),g=!1);else if(g===!1&&(ue(e.BLEND),g=!0),t!==5){if(t!==_||u!==E){if((v!==100||x!==100)&&(e.blendEquation(e.FUNC_ADD),v=100,x=100),u)switch(t){case 1:e.blendFuncSeparate(e.ONE,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFunc(e.ONE,e.ONE);break;case 3:e.blendFuncSeparate(e.ZERO,e.ONE_MINUS_SRC_COLOR,e.ZERO,e.ONE);break;case 4:e.blendFuncSeparate(e.DST_COLOR,e.ONE_MINUS_SRC_ALPHA,e.ZERO,e.ONE);break;default:q(`WebGLState: Invalid blending: `,t)}else switch(t){case 1:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE,e.ONE,e.ONE);break;case 3:q(`WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true`);break;case 4:q(`WebGLState: MultiplyBlending requires material.premultipliedAlpha = true`);break;default:q(`WebGLState: Invalid blending: `,t)}y=null,b=null,S=null,C=null,w.set(0,0,0),T=0,_=t,E=u}}else a||=n,o||=r,s||=i,(n!==v||a!==x)&&(e.blendEquationSeparate(he[n],he[a]),v=n,x=a),(r!==y||i!==b||o!==S||s!==C)&&(e.blendFuncSeparate(ge[r],ge[i],ge[o],ge[s]),y=r,b=i,S=o,C=s),(c.equals(w)===!1||l!==T)&&(e.blendColor(c.r,c.g,c.b,l),w.copy(c),T=l),_=t,E=!1}function ve(t,n){t.side===2?de(e.CULL_FACE):ue(e.CULL_FACE);let r=t.side===1;n&&(r=!r),ye(r),t.blending===1&&t.transparent===!1?_e(0):_e(t.blending,t.blendEquation,t.blendSrc,t.blendDst,t.blendEquationAlpha,t.blendSrcAlpha,t.blendDstAlpha,t.blendColor,t.blendAlpha,t.premultipliedAlpha),o.setFunc(t.depthFunc),o.setTest(t.depthTest),o.setMask(t.depthWrite),a.setMask(t.colorWrite);let i=t.stencilWrite;s.setTest(i),i&&(s.setMask(t.stencilWriteMask),s.setFunc(t.stencilFunc,t.stencilRef,t.stencilFuncMask),s.setOp(t.stencilFail,t.stencilZFail,t.stencilZPass)),Se(t.polygonOffset,t.polygonOffsetFactor,t.polygonOffsetUnits),t.alphaToCoverage===!0?ue(e.SAMPLE_ALPHA_TO_COVERAGE):de(e.SAMPLE_ALPHA_TO_COVERAGE)}function ye(t){D!==t&&(t?e.frontFace(e.CW):e.frontFace(e.CCW),D=t)}function be(t){t===0?de(e.CULL_FACE):(ue(e.CULL_FACE),t!==O&&(t===1?e.cullFace(e.BACK):t===2?e.cullFace(e.FRONT):e.cullFace(e.FRONT_AND_BACK))),O=t}function xe(t){t!==k&&(M&&e.lineWidth(t),k=t)}function Se(t,n,r){t?(ue(e.POLYGON_OFFSET_FILL),(A!==n||j!==r)&&(A=n,j=r,o.getReversed()&&(n=-n,r=-r),e.polygonOffset(n,r))):de(e.POLYGON_OFFSET_FILL)}function Ce(t){t?ue(e.SCISSOR_TEST):de(e.SCISSOR_TEST)}function we(t){t===void 0&&(t=e.TEXTURE0+ee-1),N!==t&&(e.activeTexture(t),N=t)}function P(t,n,r){r===void 0&&(r=N===null?e.TEXTURE0+ee-1:N);let i=re[r];i===void 0&&(i={type:void 0,texture:void 0},re[r]=i),(i.type!==t||i.texture!==n)&&(N!==r&&(e.activeTexture(r),N=r),e.bindTexture(t,n||le[t]),i.type=t,i.texture=n)}function Te(){let t=re[N];t!==void 0&&t.type!==void 0&&(e.bindTexture(t.type,null),t.type=void 0,t.texture=void 0)}function Ee(){try{e.compressedTexImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function De(){try{e.compressedTexImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function F(){try{e.texSubImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function I(){try{e.texSubImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function L(){try{e.compressedTexSubImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function R(){try{e.compressedTexSubImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function Oe(){try{e.texStorage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function ke(){try{e.texStorage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function Ae(){try{e.texImage2D(...arguments)}catch(e){q(`WebGLState:`,e)}}function je(){try{e.texImage3D(...arguments)}catch(e){q(`WebGLState:`,e)}}function Me(t){return d[t]===void 0?e.getParameter(t):d[t]}function Ne(t,n){d[t]!==n&&(e.pixelStorei(t,n),d[t]=n)}function Pe(t){oe.equals(t)===!1&&(e.scissor(t.x,t.y,t.z,t.w),oe.copy(t))}function Fe(t){se.equals(t)===!1&&(e.viewport(t.x,t.y,t.z,t.w),se.copy(t))}function Ie(t,n){let r=l.get(n);r===void 0&&(r=new WeakMap,l.set(n,r));let i=r.get(t);i===void 0&&(i=e.getUniformBlockIndex(n,t.name),e.uniformBlockBinding(n,i,i),r.set(t,i))}function Le(t,n,r){let i=l.get(n).get(t);c[i]!==r&&(e.bindBufferBase(e.UNIFORM_BUFFER,i,r),c[i]=r)}function Re(){e.disable(e.BLEND),e.disable(e.CULL_FACE),e.disable(e.DEPTH_TEST),e.disable(e.POLYGON_OFFSET_FILL),e.disable(e.SCISSOR_TEST),e.disable(e.STENCIL_TEST),e.disable(e.SAMPLE_ALPHA_TO_COVERAGE),e.blendEquation(e.FUNC_ADD),e.blendFunc(e.ONE,e.ZERO),e.blendFuncSeparate(e.ONE,e.ZERO,e.ONE,e.ZERO),e.blendColor(0,0,0,0),e.colorMask(!0,!0,!0,!0),e.clearColor(0,0,0,0),e.depthMask(!0),e.depthFunc(e.LESS),o.setReversed(!1),e.clearDepth(1),e.stencilMask(4294967295),e.stencilFunc(e.ALWAYS,0,4294967295),e.stencilOp(e.KEEP,e.KEEP,e.KEEP),e.clearStencil(0),e.cullFace(e.BACK),e.frontFace(e.CCW),e.polygonOffset(0,0),e.activeTexture(e.TEXTURE0),e.bindFramebuffer(e.FRAMEBUFFER,null),e.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),e.bindFramebuffer(e.READ_FRAMEBUFFER,null),e.useProgram(null),e.lineWidth(1),e.scissor(0,0,e.canvas.width,e.canvas.height),e.viewport(0,0,e.canvas.width,e.canvas.height),e.pixelStorei(e.PACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,!1),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),e.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,e.BROWSER_DEFAULT_WEBGL),e.pixelStorei(e.PACK_ROW_LENGTH,0),e.pixelStorei(e.PACK_SKIP_PIXELS,0),e.pixelStorei(e.PACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_ROW_LENGTH,0),e.pixelStorei(e.UNPACK_IMAGE_HEIGHT,0),e.pixelStorei(e.UNPACK_SKIP_PIXELS,0),e.pixelStorei(e.UNPACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_SKIP_IMAGES,0),u={},d={},N=null,re={},f={},c={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new wf(0,0,0),T=0,E=!1,D=null,O=null,k=null,A=null,j=null,oe.set(0,0,e.canvas.width,e.canvas.height),se.set(0,0,e.canvas.width,e.canvas.height),a.reset(),o.reset(),s.reset()}return{buffers:{color:a,depth:o,stencil:s},enable:ue,disable:de,bindFramebuffer:fe,drawBuffers:pe,useProgram:me,setBlending:_e,setMaterial:ve,setFlipSided:ye,setCullFace:be,setLineWidth:xe,setPolygonOffset:Se,setScissorTest:Ce,activeTexture:we,bindTexture:P,unbindTexture:Te,compressedTexImage2D:Ee,compressedTexImage3D:De,texImage2D:Ae,texImage3D:je,pixelStorei:Ne,getParameter:Me,updateUBOMapping:Ie,uniformBlockBinding:Le,texStorage2D:Oe,texStorage3D:ke,texSubImage2D:F,texSubImage3D:I,compressedTexSubImage2D:L,compressedTexSubImage3D:R,scissor:Pe,viewport:Fe,reset:Re}}function bv(e,t,n,r,i,a,o){let s=t.has(`WEBGL_multisampled_render_to_texture`)?t.get(`WEBGL_multisampled_render_to_texture`):null,c=typeof navigator>`u`?!1:/OculusBrowser/g.test(navigator.userAgent),l=new Y,u=new WeakMap,d=new Set,f,p=new WeakMap,m=new Set,h=new FinalizationRegistry(e=>m.delete(e)),g=!1;try{g=typeof OffscreenCanvas<`u`&&new OffscreenCanvas(1,1).getContext(`2d`)!==null}catch{}function _(e,t){return g?new OffscreenCanvas(e,t):Lu(`canvas`)}function v(e,t,n){let r=1,i=Oe(e);if((i.width>n||i.height>n)&&(r=n/Math.max(i.width,i.height)),r<1){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap||typeof VideoFrame<`u`&&e instanceof VideoFrame){let n=Math.floor(r*i.width),a=Math.floor(r*i.height);f===void 0&&(f=_(n,a));let o=t?_(n,a):f;return o.width=n,o.height=a,o.getContext(`2d`).drawImage(e,0,0,n,a),K(`WebGLRenderer: Texture has been resized from (`+i.width+`x`+i.height+`) to (`+n+`x`+a+`).`),o}return`data`in e&&K(`WebGLRenderer: Image in DataTexture is too big (`+i.width+`x`+i.height+`).`),e}return e}function y(e){return e.generateMipmaps}function b(t){e.generateMipmap(t)}function x(t){return t.isWebGLCubeRenderTarget?e.TEXTURE_CUBE_MAP:t.isWebGL3DRenderTarget?e.TEXTURE_3D:t.isWebGLArrayRenderTarget||t.isCompressedArrayTexture?e.TEXTURE_2D_ARRAY:e.TEXTURE_2D}function S(n,r,i,a,o,s=!1){if(n!==null){if(e[n]!==void 0)return e[n];K(`WebGLRenderer: Attempt to use non-existing WebGL internal format '`+n+`'`)}let c;a&&(c=t.get(`EXT_texture_norm16`),c||K(`WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension`));let l=r;if(r===e.RED&&(i===e.FLOAT&&(l=e.R32F),i===e.HALF_FLOAT&&(l=e.R16F),i===e.UNSIGNED_BYTE&&(l=e.R8),i===e.UNSIGNED_SHORT&&c&&(l=c.R16_EXT),i===e.SHORT&&c&&(l=c.R16_SNORM_EXT)),r===e.RED_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.R8UI),i===e.UNSIGNED_SHORT&&(l=e.R16UI),i===e.UNSIGNED_INT&&(l=e.R32UI),i===e.BYTE&&(l=e.R8I),i===e.SHORT&&(l=e.R16I),i===e.INT&&(l=e.R32I)),r===e.RG&&(i===e.FLOAT&&(l=e.RG32F),i===e.HALF_FLOAT&&(l=e.RG16F),i===e.UNSIGNED_BYTE&&(l=e.RG8),i===e.UNSIGNED_SHORT&&c&&(l=c.RG16_EXT),i===e.SHORT&&c&&(l=c.RG16_SNORM_EXT)),r===e.RG_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RG8UI),i===e.UNSIGNED_SHORT&&(l=e.RG16UI),i===e.UNSIGNED_INT&&(l=e.RG32UI),i===e.BYTE&&(l=e.RG8I),i===e.SHORT&&(l=e.RG16I),i===e.INT&&(l=e.RG32I)),r===e.RGB_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGB8UI),i===e.UNSIGNED_SHORT&&(l=e.RGB16UI),i===e.UNSIGNED_INT&&(l=e.RGB32UI),i===e.BYTE&&(l=e.RGB8I),i===e.SHORT&&(l=e.RGB16I),i===e.INT&&(l=e.RGB32I)),r===e.RGBA_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGBA8UI),i===e.UNSIGNED_SHORT&&(l=e.RGBA16UI),i===e.UNSIGNED_INT&&(l=e.RGBA32UI),i===e.BYTE&&(l=e.RGBA8I),i===e.SHORT&&(l=e.RGBA16I),i===e.INT&&(l=e.RGBA32I)),r===e.RGB&&(i===e.UNSIGNED_SHORT&&c&&(l=c.RGB16_EXT),i===e.SHORT&&c&&(l=c.RGB16_SNORM_EXT),i===e.UNSIGNED_INT_5_9_9_9_REV&&(l=e.RGB9_E5),i===e.UNSIGNED_INT_10F_11F_11F_REV&&(l=e.R11F_G11F_B10F)),r===e.RGBA){let t=s?ku:Ed.getTransfer(o);i===e.FLOAT&&(l=e.RGBA32F),i===e.HALF_FLOAT&&(l=e.RGBA16F),i===e.UNSIGNED_BYTE&&(l=t===`srgb`?e.SRGB8_ALPHA8:e.RGBA8),i===e.UNSIGNED_SHORT&&c&&(l=c.RGBA16_EXT),i===e.SHORT&&c&&(l=c.RGBA16_SNORM_EXT),i===e.UNSIGNED_SHORT_4_4_4_4&&(l=e.RGBA4),i===e.UNSIGNED_SHORT_5_5_5_1&&(l=e.RGB5_A1)}return(l===e.R16F||l===e.R32F||l===e.RG16F||l===e.RG32F||l===e.RGBA16F||l===e.RGBA32F)&&t.get(`EXT_color_buffer_float`),l}function C(t,n){let r;return t?n===null||n===1014||n===1020?r=e.DEPTH24_STENCIL8:n===1015?r=e.DEPTH32F_STENCIL8:n===1012&&(r=e.DEPTH24_STENCIL8,K(`DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.`)):n===null||n===1014||n===1020?r=e.DEPTH_COMPONENT24:n===1015?r=e.DEPTH_COMPONENT32F:n===1012&&(r=e.DEPTH_COMPONENT16),r}function w(e,t){return y(e)===!0||e.isFramebufferTexture&&e.minFilter!==1003&&e.minFilter!==1006?Math.log2(Math.max(t.width,t.height))+1:e.mipmaps.length>0?e.mipmaps.length:e.isCompressedTexture&&Array.isArray(e.image)?t.mipmaps.length:1}function T(e){let t=new WeakRef(e);r.get(e).__ref=t,m.add(t),h.register(e,t,t)}function E(e){let t=r.get(e).__ref;t!==void 0&&(m.delete(t),h.unregister(t))}function D(e){k(e.target)}function O(e){A(e.target)}function k(e){e.removeEventListener(`dispose`,D),E(e),ee(e),e.isVideoTexture&&u.delete(e),e.isHTMLTexture&&d.delete(e)}function A(e){e.removeEventListener(`dispose`,O),E(e),te(e)}function j(){for(let e of m){let t=e.deref();t!==void 0&&(t.isRenderTarget===!0?A(t):k(t))}m.clear(),d.clear()}function ee(e){let t=r.get(e);if(t.__webglInit===void 0)return;let n=e.source,i=p.get(n);if(i){let r=i[t.__cacheKey];r.usedTimes--,r.usedTimes===0&&M(e),Object.keys(i).length===0&&p.delete(n)}r.remove(e)}function M(t){let n=r.get(t);e.deleteTexture(n.__webglTexture);let i=t.source,a=p.get(i);delete a[n.__cacheKey],o.memory.textures--}function te(t){let n=r.get(t);n.__depthDisposeCallback&&n.__depthDisposeCallback();let i=t.depthTexture;if(i&&i.renderTarget===t&&k(i),t.isWebGLCubeRenderTarget)for(let t=0;t<6;t++){if(Array.isArray(n.__webglFramebuffer[t]))for(let r=0;r<n.__webglFramebuffer[t].length;r++)e.deleteFramebuffer(n.__webglFramebuffer[t][r]);else e.deleteFramebuffer(n.__webglFramebuffer[t]);n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer[t])}else{if(Array.isArray(n.__webglFramebuffer))for(let t=0;t<n.__webglFramebuffer.length;t++)e.deleteFramebuffer(n.__webglFramebuffer[t]);else e.deleteFramebuffer(n.__webglFramebuffer);if(n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer),n.__webglMultisampledFramebuffer&&e.deleteFramebuffer(n.__webglMultisampledFramebuffer),n.__webglColorRenderbuffer)for(let t=0;t<n.__webglColorRenderbuffer.length;t++)n.__webglColorRenderbuffer[t]&&e.deleteRenderbuffer(n.__webglColorRenderbuffer[t]);n.__webglDepthRenderbuffer&&e.deleteRenderbuffer(n.__webglDepthRenderbuffer)}let a=t.textures;for(let t=0,n=a.length;t<n;t++){let n=r.get(a[t]);n.__webglTexture&&(e.deleteTexture(n.__webglTexture),o.memory.textures--),r.remove(a[t])}r.remove(t)}let ne=0;function N(){ne=0}function re(){return ne}function ie(e){ne=e}function ae(){let e=ne;return e>=i.maxTextures&&K(`WebGLTextures: Trying to use `+(e+1)+` texture units while this GPU supports only `+i.maxTextures),ne+=1,e}function oe(e){let t=[];return t.push(e.wrapS),t.push(e.wrapT),t.push(e.wrapR||0),t.push(e.magFilter),t.push(e.minFilter),t.push(e.anisotropy),t.push(e.internalFormat),t.push(e.format),t.push(e.type),t.push(e.generateMipmaps),t.push(e.mipmapsAutoUpdate),t.push(e.premultiplyAlpha),t.push(e.flipY),t.push(e.unpackAlignment),t.push(e.colorSpace),t.join()}function se(t,i){let a=r.get(t);if(t.isVideoTexture&&L(t),t.isRenderTargetTexture===!1&&t.isExternalTexture!==!0&&t.version>0&&a.__version!==t.version){let e=t.image;if(e===null)K(`WebGLRenderer: Texture marked for update but no image data found.`);else if(e.complete===!1)K(`WebGLRenderer: Texture marked for update but image is incomplete`);else{ve(a,t,i);return}}else t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null);n.bindTexture(e.TEXTURE_2D,a.__webglTexture,e.TEXTURE0+i)}function ce(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?ve(a,t,i):(t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null),n.bindTexture(e.TEXTURE_2D_ARRAY,a.__webglTexture,e.TEXTURE0+i))}function le(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?ve(a,t,i):n.bindTexture(e.TEXTURE_3D,a.__webglTexture,e.TEXTURE0+i)}function ue(t,i){let a=r.get(t);t.version>0&&a.__version!==t.version?ye(a,t,i):n.bindTexture(e.TEXTURE_CUBE_MAP,a.__webglTexture,e.TEXTURE0+i)}let de={[al]:e.REPEAT,[ol]:e.CLAMP_TO_EDGE,[sl]:e.MIRRORED_REPEAT},fe={[cl]:e.NEAREST,[ll]:e.NEAREST_MIPMAP_NEAREST,[ul]:e.NEAREST_MIPMAP_LINEAR,[dl]:e.LINEAR,[fl]:e.LINEAR_MIPMAP_NEAREST,[pl]:e.LINEAR_MIPMAP_LINEAR},pe={512:e.NEVER,519:e.ALWAYS,513:e.LESS,515:e.LEQUAL,514:e.EQUAL,518:e.GEQUAL,516:e.GREATER,517:e.NOTEQUAL};function me(n,a){if(a.type===1015&&t.has(`OES_texture_float_linear`)===!1&&(a.magFilter===1006||a.magFilter===1007||a.magFilter===1005||a.magFilter===1008||a.minFilter===1006||a.minFilter===1007||a.minFilter===1005||a.minFilter===1008)&&K(`WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device.`),e.texParameteri(n,e.TEXTURE_WRAP_S,de[a.wrapS]),e.texParameteri(n,e.TEXTURE_WRAP_T,de[a.wrapT]),(n===e.TEXTURE_3D||n===e.TEXTURE_2D_ARRAY)&&e.texParameteri(n,e.TEXTURE_WRAP_R,de[a.wrapR]),e.texParameteri(n,e.TEXTURE_MAG_FILTER,fe[a.magFilter]),e.texParameteri(n,e.TEXTURE_MIN_FILTER,fe[a.minFilter]),a.compareFunction&&(e.texParameteri(n,e.TEXTURE_COMPARE_MODE,e.COMPARE_REF_TO_TEXTURE),e.texParameteri(n,e.TEXTURE_COMPARE_FUNC,pe[a.compareFunction])),t.has(`EXT_texture_filter_anisotropic`)===!0){if(a.magFilter===1003||a.minFilter!==1005&&a.minFilter!==1008||a.type===1015&&t.has(`OES_texture_float_linear`)===!1)return;if(a.anisotropy>1||r.get(a).__currentAnisotropy){let o=t.get(`EXT_texture_filter_anisotropic`);e.texParameterf(n,o.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(a.anisotropy,i.getMaxAnisotropy())),r.get(a).__currentAnisotropy=a.anisotropy}}}function he(t,n){let r=!1;t.__webglInit===void 0&&(t.__webglInit=!0,n.addEventListener(`dispose`,D),T(n));let i=n.source,a=p.get(i);a===void 0&&(a={},p.set(i,a));let s=oe(n);if(s!==t.__cacheKey){a[s]===void 0&&(a[s]={texture:e.createTexture(),usedTimes:0},o.memory.textures++,r=!0),a[s].usedTimes++;let i=a[t.__cacheKey];i!==void 0&&(a[t.__cacheKey].usedTimes--,i.usedTimes===0&&M(n)),t.__cacheKey=s,t.__webglTexture=a[s].texture}return r}function ge(e,t,n){return Math.floor(Math.floor(e/n)/t)}function _e(t,r,i,a){let o=t.updateRanges;if(o.length===0)n.texSubImage2D(e.TEXTURE_2D,0,0,0,r.width,r.height,i,a,r.data);else{o.sort((e,t)=>e.start-t.start);let s=0;for(let e=1;e<o.length;e++){let t=o[s],n=o[e],i=t.start+t.count,a=ge(n.start,r.width,4),c=ge(t.start,r.width,4);n.start<=i+1&&a===c&&ge(n.start+n.count-1,r.width,4)===a?t.count=Math.max(t.count,n.start+n.count-t.start):(++s,o[s]=n)}o.length=s+1;let c=n.getParameter(e.UNPACK_ROW_LENGTH),l=n.getParameter(e.UNPACK_SKIP_PIXELS),u=n.getParameter(e.UNPACK_SKIP_ROWS);n.pixelStorei(e.UNPACK_ROW_LENGTH,r.width);for(let t=0,s=o.length;t<s;t++){let s=o[t],c=Math.floor(s.start/4),l=Math.ceil(s.count/4),u=c%r.width,d=Math.floor(c/r.width),f=l;n.pixelStorei(e.UNPACK_SKIP_PIXELS,u),n.pixelStorei(e.UNPACK_SKIP_ROWS,d),n.texSubImage2D(e.TEXTURE_2D,0,u,d,f,1,i,a,r.data)}t.clearUpdateRanges(),n.pixelStorei(e.UNPACK_ROW_LENGTH,c),n.pixelStorei(e.UNPACK_SKIP_PIXELS,l),n.pixelStorei(e.UNPACK_SKIP_ROWS,u)}}function ve(t,o,s){let c=e.TEXTURE_2D;(o.isDataArrayTexture||o.isCompressedArrayTexture)&&(c=e.TEXTURE_2D_ARRAY),o.isData3DTexture&&(c=e.TEXTURE_3D);let l=he(t,o),u=o.source;n.bindTexture(c,t.__webglTexture,e.TEXTURE0+s);let f=r.get(u);if(u.version!==f.__version||l===!0){if(n.activeTexture(e.TEXTURE0+s),!(typeof ImageBitmap<`u`&&o.image instanceof ImageBitmap)){let t=Ed.getPrimaries(Ed.workingColorSpace),r=o.colorSpace===``?null:Ed.getPrimaries(o.colorSpace),i=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,i)}n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment);let t=v(o.image,!1,i.maxTextureSize);t=R(o,t);let r=a.convert(o.format,o.colorSpace),p=a.convert(o.type),m=S(o.internalFormat,r,p,o.normalized,o.colorSpace,o.isVideoTexture);me(c,o);let h,g=o.mipmaps,_=o.isVideoTexture!==!0,x=f.__version===void 0||l===!0,T=u.dataReady,E=w(o,t);if(o.isDepthTexture)m=C(o.format===jl,o.type),x&&(_?n.texStorage2D(e.TEXTURE_2D,1,m,t.width,t.height):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,null));else if(o.isDataTexture){if(g.length>0){_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data);o.generateMipmaps=!1}else _?(x&&n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height),T&&_e(o,t,r,p)):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,t.data)}else if(o.isCompressedTexture){if(o.isCompressedArrayTexture){_&&x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,g[0].width,g[0].height,t.depth);for(let i=0,a=g.length;i<a;i++)if(h=g[i],o.format!==1023){if(r!==null){if(_){if(T){if(o.layerUpdates.size>0){let t=Sh(h.width,h.height,o.format,o.type);for(let a of o.layerUpdates){let o=h.data.subarray(a*t/h.data.BYTES_PER_ELEMENT,(a+1)*t/h.data.BYTES_PER_ELEMENT);n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,a,h.width,h.height,1,r,o)}}else n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,h.data)}}else n.compressedTexImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,h.data,0,0)}else K(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`)}else _?T&&n.texSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,p,h.data):n.texImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,r,p,h.data);o.layerUpdates.size>0&&o.clearLayerUpdates()}else{_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],o.format===1023?_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data):r===null?K(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`):_?T&&n.compressedTexSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,h.data):n.compressedTexImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,h.data)}}else if(o.isDataArrayTexture){if(_){if(x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,t.width,t.height,t.depth),T){if(o.layerUpdates.size>0){let i=Sh(t.width,t.height,o.format,o.type);for(let a of o.layerUpdates){let o=t.data.subarray(a*i/t.data.BYTES_PER_ELEMENT,(a+1)*i/t.data.BYTES_PER_ELEMENT);n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,a,t.width,t.height,1,r,p,o)}o.clearLayerUpdates()}else n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)}}else n.texImage3D(e.TEXTURE_2D_ARRAY,0,m,t.width,t.height,t.depth,0,r,p,t.data)}else if(o.isData3DTexture)_?(x&&n.texStorage3D(e.TEXTURE_3D,E,m,t.width,t.height,t.depth),T&&n.texSubImage3D(e.TEXTURE_3D,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)):n.texImage3D(e.TEXTURE_3D,0,m,t.width,t.height,t.depth,0,r,p,t.data);else if(o.isFramebufferTexture){if(x){if(_)n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height);else{let i=t.width,a=t.height;for(let t=0;t<E;t++)n.texImage2D(e.TEXTURE_2D,t,m,i,a,0,r,p,null),i>>=1,a>>=1}}}else if(o.isHTMLTexture){if(`texElementImage2D`in e){let n=e.canvas;if(n.hasAttribute(`layoutsubtree`)||n.setAttribute(`layoutsubtree`,`true`),t.parentNode!==n){n.appendChild(t),d.add(o),n.onpaint=e=>{let t=e.changedElements;for(let e of d)t.includes(e.image)&&(e.needsUpdate=!0)},n.requestPaint();return}if(e.texElementImage2D.length===3)e.texElementImage2D(e.TEXTURE_2D,e.RGBA8,t);else{let n=e.RGBA,r=e.RGBA,i=e.UNSIGNED_BYTE;e.texElementImage2D(e.TEXTURE_2D,0,n,r,i,t)}e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,e.LINEAR),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_S,e.CLAMP_TO_EDGE),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_T,e.CLAMP_TO_EDGE)}}else if(g.length>0){if(_&&x){let t=Oe(g[0]);n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height)}for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,r,p,h):n.texImage2D(e.TEXTURE_2D,t,m,r,p,h);o.generateMipmaps=!1}else if(_){if(x){let r=Oe(t);n.texStorage2D(e.TEXTURE_2D,E,m,r.width,r.height)}T&&n.texSubImage2D(e.TEXTURE_2D,0,0,0,r,p,t)}else n.texImage2D(e.TEXTURE_2D,0,m,r,p,t);y(o)&&o.mipmapsAutoUpdate===!0&&b(c),f.__version=u.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function ye(t,o,s){if(o.image.length!==6)return;let c=he(t,o),l=o.source;n.bindTexture(e.TEXTURE_CUBE_MAP,t.__webglTexture,e.TEXTURE0+s);let u=r.get(l);if(l.version!==u.__version||c===!0){n.activeTexture(e.TEXTURE0+s);let t=Ed.getPrimaries(Ed.workingColorSpace),r=o.colorSpace===``?null:Ed.getPrimaries(o.colorSpace),d=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,d);let f=o.isCompressedTexture||o.image[0].isCompressedTexture,p=o.image[0]&&o.image[0].isDataTexture,m=[];for(let e=0;e<6;e++)!f&&!p?m[e]=v(o.image[e],!0,i.maxCubemapSize):m[e]=p?o.image[e].image:o.image[e],m[e]=R(o,m[e]);let h=m[0],g=a.convert(o.format,o.colorSpace),_=a.convert(o.type),x=S(o.internalFormat,g,_,o.normalized,o.colorSpace),T=o.isVideoTexture!==!0,E=u.__version===void 0||c===!0,D=l.dataReady,O=w(o,h);me(e.TEXTURE_CUBE_MAP,o);let k;if(o.isDepthTexture){if(x=C(o.format===jl,o.type),E){if(T)n.texStorage2D(e.TEXTURE_CUBE_MAP,1,x,h.width,h.height);else for(let t=0;t<6;t++)n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,h.width,h.height,0,g,_,null)}}else if(f){T&&E&&n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,h.width,h.height);for(let t=0;t<6;t++){k=m[t].mipmaps;for(let r=0;r<k.length;r++){let i=k[r];o.format===1023?T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,g,_,i.data):g===null?K(`WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()`):T?D&&n.compressedTexSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,i.data):n.compressedTexImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,i.data)}}}else{if(k=o.mipmaps,T&&E){k.length>0&&O++;let t=Oe(m[0]);n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,t.width,t.height)}for(let t=0;t<6;t++)if(p){T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,m[t].width,m[t].height,g,_,m[t].data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,m[t].width,m[t].height,0,g,_,m[t].data);for(let r=0;r<k.length;r++){let i=k[r].image[t].image;T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,i.width,i.height,0,g,_,i.data)}}else{T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,g,_,m[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,g,_,m[t]);for(let r=0;r<k.length;r++){let i=k[r];T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,g,_,i.image[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,g,_,i.image[t])}}}y(o)&&o.mipmapsAutoUpdate===!0&&b(e.TEXTURE_CUBE_MAP),u.__version=l.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function be(t,i,o,c,l,u){let d=a.convert(o.format,o.colorSpace),f=a.convert(o.type),p=S(o.internalFormat,d,f,o.normalized,o.colorSpace),m=r.get(i),h=r.get(o);if(h.__renderTarget=i,!m.__hasExternalTextures){let t=Math.max(1,i.width>>u),r=Math.max(1,i.height>>u);l===e.TEXTURE_3D||l===e.TEXTURE_2D_ARRAY?n.texImage3D(l,u,p,t,r,i.depth,0,d,f,null):n.texImage2D(l,u,p,t,r,0,d,f,null)}n.bindFramebuffer(e.FRAMEBUFFER,t),I(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,c,l,h.__webglTexture,0,F(i)):(l===e.TEXTURE_2D||l>=e.TEXTURE_CUBE_MAP_POSITIVE_X&&l<=e.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&e.framebufferTexture2D(e.FRAMEBUFFER,c,l,h.__webglTexture,u),n.bindFramebuffer(e.FRAMEBUFFER,null)}function xe(t,n,r){if(e.bindRenderbuffer(e.RENDERBUFFER,t),n.depthBuffer){let i=n.depthTexture,a=i&&i.isDepthTexture?i.type:null,o=C(n.stencilBuffer,a),c=n.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;I(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,F(n),o,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,F(n),o,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,o,n.width,n.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,c,e.RENDERBUFFER,t)}else{let t=n.textures;for(let i=0;i<t.length;i++){let o=t[i],c=a.convert(o.format,o.colorSpace),l=a.convert(o.type),u=S(o.internalFormat,c,l,o.normalized,o.colorSpace);I(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,F(n),u,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,F(n),u,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,u,n.width,n.height)}}e.bindRenderbuffer(e.RENDERBUFFER,null)}function Se(t,i,a){let o=i.isWebGLCubeRenderTarget===!0;if(n.bindFramebuffer(e.FRAMEBUFFER,t),!(i.depthTexture&&i.depthTexture.isDepthTexture))throw Error(`THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.`);let c=r.get(i.depthTexture);c.__renderTarget=i;let l=o?i.depthTexture.image[0]:i.depthTexture.image;c.__webglTexture&&l.width===i.width&&l.height===i.height||(l.width=i.width,l.height=i.height,i.depthTexture.needsUpdate=!0),o?ue(i.depthTexture,0):se(i.depthTexture,0);let u=c.__webglTexture,d=F(i),f=o?e.TEXTURE_CUBE_MAP_POSITIVE_X+a:e.TEXTURE_2D,p=i.depthTexture.format===1027?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;if(i.depthTexture.format===1026)I(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else if(i.depthTexture.format===1027)I(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else throw Error(`THREE.WebGLTextures: Unknown depthTexture format.`)}function Ce(t){let i=r.get(t),a=t.isWebGLCubeRenderTarget===!0;if(i.__boundDepthTexture!==t.depthTexture){let e=t.depthTexture;if(i.__depthDisposeCallback&&i.__depthDisposeCallback(),e){let t=()=>{delete i.__boundDepthTexture,delete i.__depthDisposeCallback,e.removeEventListener(`dispose`,t)};e.addEventListener(`dispose`,t),i.__depthDisposeCallback=t}i.__boundDepthTexture=e}if(t.depthTexture&&!i.__autoAllocateDepthBuffer){if(a)for(let e=0;e<6;e++)Se(i.__webglFramebuffer[e],t,e);else t.texture.mipmaps.length>0?Se(i.__webglFramebuffer[0],t,0):Se(i.__webglFramebuffer,t,0)}else if(a){i.__webglDepthbuffer=[];for(let r=0;r<6;r++)if(n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[r]),i.__webglDepthbuffer[r]===void 0)i.__webglDepthbuffer[r]=e.createRenderbuffer(),xe(i.__webglDepthbuffer[r],t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,a=i.__webglDepthbuffer[r];e.bindRenderbuffer(e.RENDERBUFFER,a),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,a)}}else if(t.texture.mipmaps.length>0?n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[0]):n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer),i.__webglDepthbuffer===void 0)i.__webglDepthbuffer=e.createRenderbuffer(),xe(i.__webglDepthbuffer,t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,r=i.__webglDepthbuffer;e.bindRenderbuffer(e.RENDERBUFFER,r),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,r)}n.bindFramebuffer(e.FRAMEBUFFER,null)}function we(t,n,i){let a=r.get(t);n!==void 0&&be(a.__webglFramebuffer,t,t.texture,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,0),i!==void 0&&Ce(t)}function P(t){let i=t.texture,s=r.get(t),c=r.get(i);t.addEventListener(`dispose`,O),T(t);let l=t.textures,u=t.isWebGLCubeRenderTarget===!0,d=l.length>1;if(d||(c.__webglTexture===void 0&&(c.__webglTexture=e.createTexture()),c.__version=i.version,o.memory.textures++),u){s.__webglFramebuffer=[];for(let t=0;t<6;t++)if(i.mipmaps.length>0){s.__webglFramebuffer[t]=[];for(let n=0;n<i.mipmaps.length;n++)s.__webglFramebuffer[t][n]=e.createFramebuffer()}else s.__webglFramebuffer[t]=e.createFramebuffer()}else{if(i.mipmaps.length>0){s.__webglFramebuffer=[];for(let t=0;t<i.mipmaps.length;t++)s.__webglFramebuffer[t]=e.createFramebuffer()}else s.__webglFramebuffer=e.createFramebuffer();if(d)for(let t=0,n=l.length;t<n;t++){let n=r.get(l[t]);n.__webglTexture===void 0&&(n.__webglTexture=e.createTexture(),o.memory.textures++)}if(t.samples>0&&I(t)===!1){s.__webglMultisampledFramebuffer=e.createFramebuffer(),s.__webglColorRenderbuffer=[],n.bindFramebuffer(e.FRAMEBUFFER,s.__webglMultisampledFramebuffer);for(let n=0;n<l.length;n++){let r=l[n];s.__webglColorRenderbuffer[n]=e.createRenderbuffer(),e.bindRenderbuffer(e.RENDERBUFFER,s.__webglColorRenderbuffer[n]);let i=a.convert(r.format,r.colorSpace),o=a.convert(r.type),c=S(r.internalFormat,i,o,r.normalized,r.colorSpace,t.isXRRenderTarget===!0),u=F(t);e.renderbufferStorageMultisample(e.RENDERBUFFER,u,c,t.width,t.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+n,e.RENDERBUFFER,s.__webglColorRenderbuffer[n])}e.bindRenderbuffer(e.RENDERBUFFER,null),t.depthBuffer&&(s.__webglDepthRenderbuffer=e.createRenderbuffer(),xe(s.__webglDepthRenderbuffer,t,!0)),n.bindFramebuffer(e.FRAMEBUFFER,null)}}if(u){n.bindTexture(e.TEXTURE_CUBE_MAP,c.__webglTexture),me(e.TEXTURE_CUBE_MAP,i);for(let n=0;n<6;n++)if(i.mipmaps.length>0)for(let r=0;r<i.mipmaps.length;r++)be(s.__webglFramebuffer[n][r],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,r);else be(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,0);y(i)?b(e.TEXTURE_CUBE_MAP):i.mipmaps.length>0&&e.texParameteri(e.TEXTURE_CUBE_MAP,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}else if(d){for(let i=0,a=l.length;i<a;i++){let a=l[i],o=r.get(a),c=e.TEXTURE_2D;(t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(c=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(c,o.__webglTexture),me(c,a),be(s.__webglFramebuffer,t,a,e.COLOR_ATTACHMENT0+i,c,0),y(a)&&b(c)}n.unbindTexture()}else{let r=e.TEXTURE_2D;if((t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(r=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(r,c.__webglTexture),me(r,i),i.mipmaps.length>0)for(let n=0;n<i.mipmaps.length;n++)be(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,r,n);else be(s.__webglFramebuffer,t,i,e.COLOR_ATTACHMENT0,r,0);y(i)?b(r):i.mipmaps.length>0&&e.texParameteri(r,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}t.depthBuffer&&Ce(t)}function Te(e){let t=e.textures;for(let i=0,a=t.length;i<a;i++){let a=t[i];if(y(a)&&a.mipmapsAutoUpdate===!0){let t=x(e),i=r.get(a).__webglTexture;n.bindTexture(t,i),b(t),n.unbindTexture()}}}let Ee=[];function De(t){if(t.samples>0){if(I(t)===!1){let i=t.textures,a=t.width,o=t.height,s=e.COLOR_BUFFER_BIT,l=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,u=r.get(t),d=i.length>1;if(d)for(let t=0;t<i.length;t++)n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,null),n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,null,0);n.bindFramebuffer(e.READ_FRAMEBUFFER,u.__webglMultisampledFramebuffer),t.texture.mipmaps.length>0?n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer[0]):n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer);for(let n=0;n<i.length;n++){if(t.resolveDepthBuffer&&(t.depthBuffer&&(s|=e.DEPTH_BUFFER_BIT),t.stencilBuffer&&t.resolveStencilBuffer&&(s|=e.STENCIL_BUFFER_BIT)),d){e.framebufferRenderbuffer(e.READ_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.RENDERBUFFER,u.__webglColorRenderbuffer[n]);let t=r.get(i[n]).__webglTexture;e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,t,0)}e.blitFramebuffer(0,0,a,o,0,0,a,o,s,e.NEAREST),c===!0&&(Ee.length=0,Ee.push(e.COLOR_ATTACHMENT0+n),t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&Ee.push(l),e.invalidateFramebuffer(e.READ_FRAMEBUFFER,Ee))}if(n.bindFramebuffer(e.READ_FRAMEBUFFER,null),n.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),d)for(let t=0;t<i.length;t++){n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,u.__webglColorRenderbuffer[t]);let a=r.get(i[t]).__webglTexture;n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,a,0)}n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglMultisampledFramebuffer)}else if(t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&c){let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;e.invalidateFramebuffer(e.DRAW_FRAMEBUFFER,[n])}}}function F(e){return Math.min(i.maxSamples,e.samples)}function I(e){let n=r.get(e);return e.samples>0&&t.has(`WEBGL_multisampled_render_to_texture`)===!0&&n.__useRenderToTexture!==!1}function L(e){let t=o.render.frame;u.get(e)!==t&&(u.set(e,t),e.update())}function R(e,t){let n=e.colorSpace,r=e.format,i=e.type;return e.isCompressedTexture===!0||e.isVideoTexture===!0||n!==`srgb-linear`&&n!==``&&(Ed.getTransfer(n)===`srgb`?(r!==1023||i!==1009)&&K(`WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType.`):q(`WebGLTextures: Unsupported texture color space:`,n)),t}function Oe(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement?(l.width=e.naturalWidth||e.width,l.height=e.naturalHeight||e.height):typeof VideoFrame<`u`&&e instanceof VideoFrame?(l.width=e.displayWidth,l.height=e.displayHeight):(l.width=e.width,l.height=e.height),l}this.allocateTextureUnit=ae,this.resetTextureUnits=N,this.getTextureUnits=re,this.setTextureUnits=ie,this.setTexture2D=se,this.setTexture2DArray=ce,this.setTexture3D=le,this.setTextureCube=ue,this.rebindTextures=we,this.setupRenderTarget=P,this.updateRenderTargetMipmap=Te,this.updateMultisampleRenderTarget=De,this.setupDepthRenderbuffer=Ce,this.setupFrameBufferTexture=be,this.useMultisampledRTT=I,this.dispose=j}function xv(e,t){function n(n,r=``){let i,a=Ed.getTransfer(r);if(n===1009)return e.UNSIGNED_BYTE;if(n===1017)return e.UNSIGNED_SHORT_4_4_4_4;if(n===1018)return e.UNSIGNED_SHORT_5_5_5_1;if(n===35902)return e.UNSIGNED_INT_5_9_9_9_REV;if(n===35899)return e.UNSIGNED_INT_10F_11F_11F_REV;if(n===1010)return e.BYTE;if(n===1011)return e.SHORT;if(n===1012)return e.UNSIGNED_SHORT;if(n===1013)return e.INT;if(n===1014)return e.UNSIGNED_INT;if(n===1015)return e.FLOAT;if(n===1016)return e.HALF_FLOAT;if(n===1021)return e.ALPHA;if(n===1022)return e.RGB;if(n===1023)return e.RGBA;if(n===1026)return e.DEPTH_COMPONENT;if(n===1027)return e.DEPTH_STENCIL;if(n===1028)return e.RED;if(n===1029)return e.RED_INTEGER;if(n===1030)return e.RG;if(n===1031)return e.RG_INTEGER;if(n===1033)return e.RGBA_INTEGER;if(n===33776||n===33777||n===33778||n===33779){if(a===`srgb`){if(i=t.get(`WEBGL_compressed_texture_s3tc_srgb`),i!==null){if(n===33776)return i.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null}else if(i=t.get(`WEBGL_compressed_texture_s3tc`),i!==null){if(n===33776)return i.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null}if(n===35840||n===35841||n===35842||n===35843){if(i=t.get(`WEBGL_compressed_texture_pvrtc`),i!==null){if(n===35840)return i.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===35841)return i.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===35842)return i.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===35843)return i.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null}if(n===36196||n===37492||n===37496||n===37488||n===37489||n===37490||n===37491){if(i=t.get(`WEBGL_compressed_texture_etc`),i!==null){if(n===36196||n===37492)return a===`srgb`?i.COMPRESSED_SRGB8_ETC2:i.COMPRESSED_RGB8_ETC2;if(n===37496)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:i.COMPRESSED_RGBA8_ETC2_EAC;if(n===37488)return i.COMPRESSED_R11_EAC;if(n===37489)return i.COMPRESSED_SIGNED_R11_EAC;if(n===37490)return i.COMPRESSED_RG11_EAC;if(n===37491)return i.COMPRESSED_SIGNED_RG11_EAC}else return null}if(n===37808||n===37809||n===37810||n===37811||n===37812||n===37813||n===37814||n===37815||n===37816||n===37817||n===37818||n===37819||n===37820||n===37821){if(i=t.get(`WEBGL_compressed_texture_astc`),i!==null){if(n===37808)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:i.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===37809)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:i.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===37810)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:i.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===37811)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:i.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===37812)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:i.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===37813)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:i.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===37814)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:i.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===37815)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:i.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===37816)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:i.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===37817)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:i.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===37818)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:i.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===37819)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:i.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===37820)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:i.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===37821)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:i.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null}if(n===36492||n===36494||n===36495){if(i=t.get(`EXT_texture_compression_bptc`),i!==null){if(n===36492)return a===`srgb`?i.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:i.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===36494)return i.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===36495)return i.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null}if(n===36283||n===36284||n===36285||n===36286){if(i=t.get(`EXT_texture_compression_rgtc`),i!==null){if(n===36283)return i.COMPRESSED_RED_RGTC1_EXT;if(n===36284)return i.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===36285)return i.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===36286)return i.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null}return n===1020?e.UNSIGNED_INT_24_8:e[n]===void 0?null:e[n]}return{convert:n}}var Sv=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,Cv=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,wv=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new fm(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new Tm({vertexShader:Sv,fragmentShader:Cv,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Wp(new hm(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Tv=class extends Gu{constructor(e,t){super();let n=this,r=null,i=1,a=null,o=`local-floor`,s=1,c=null,l=null,u=null,d=null,f=null,p=null,m=typeof XRWebGLBinding<`u`,h=new wv,g={},_=t.getContextAttributes(),v=null,y=null,b=[],x=[],S=new Y,C=null,w=null,T=new nh;T.viewport=new Ld;let E=new nh;E.viewport=new Ld;let D=[T,E],O=new sh,k=null,A=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(e){let t=b[e];return t===void 0&&(t=new yf,b[e]=t),t.getTargetRaySpace()},this.getControllerGrip=function(e){let t=b[e];return t===void 0&&(t=new yf,b[e]=t),t.getGripSpace()},this.getHand=function(e){let t=b[e];return t===void 0&&(t=new yf,b[e]=t),t.getHandSpace()};function j(e){let t=x.indexOf(e.inputSource);if(t===-1)return;let n=b[t];n!==void 0&&(n.update(e.inputSource,e.frame,c||a),n.dispatchEvent({type:e.type,data:e.inputSource}))}function ee(){r.removeEventListener(`select`,j),r.removeEventListener(`selectstart`,j),r.removeEventListener(`selectend`,j),r.removeEventListener(`squeeze`,j),r.removeEventListener(`squeezestart`,j),r.removeEventListener(`squeezeend`,j),r.removeEventListener(`end`,ee),r.removeEventListener(`inputsourceschange`,M);for(let e=0;e<b.length;e++){let t=x[e];t!==null&&(x[e]=null,b[e].disconnect(t))}k=null,A=null,h.reset();for(let e in g)delete g[e];if(e.setRenderTarget(v),f=null,d=null,u=null,r=null,y=null,ie.stop(),n.isPresenting=!1,e.setPixelRatio(C),e.setSize(S.width,S.height,!1),w!==null){let e=w.camera;e.fov=w.fov,e.zoom=w.zoom,e.updateProjectionMatrix(),w=null}n.dispatchEvent({type:`sessionend`})}this.setFramebufferScaleFactor=function(e){i=e,n.isPresenting===!0&&K(`WebXRManager: Cannot change framebuffer scale while presenting.`)},this.setReferenceSpaceType=function(e){o=e,n.isPresenting===!0&&K(`WebXRManager: Cannot change reference space type while presenting.`)},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(e){c=e},this.getBaseLayer=function(){return d===null?f:d},this.getBinding=function(){return u===null&&m&&(u=new XRWebGLBinding(r,t)),u},this.getFrame=function(){return p},this.getSession=function(){return r},this.setSession=async function(l){if(r=l,r!==null){if(v=e.getRenderTarget(),r.addEventListener(`select`,j),r.addEventListener(`selectstart`,j),r.addEventListener(`selectend`,j),r.addEventListener(`squeeze`,j),r.addEventListener(`squeezestart`,j),r.addEventListener(`squeezeend`,j),r.addEventListener(`end`,ee),r.addEventListener(`inputsourceschange`,M),_.xrCompatible!==!0&&await t.makeXRCompatible(),C=e.getPixelRatio(),e.getSize(S),m&&`createProjectionLayer`in XRWebGLBinding.prototype){let n=null,a=null,o=null;_.depth&&(o=_.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,n=_.stencil?jl:Al,a=_.stencil?wl:yl);let s={colorFormat:t.RGBA8,depthFormat:o,scaleFactor:i};u=this.getBinding(),d=u.createProjectionLayer(s),r.updateRenderState({layers:[d]}),e.setPixelRatio(1),e.setSize(d.textureWidth,d.textureHeight,!1),y=new zd(d.textureWidth,d.textureHeight,{format:kl,type:ml,depthTexture:new um(d.textureWidth,d.textureHeight,a,void 0,void 0,void 0,void 0,void 0,void 0,n),stencilBuffer:_.stencil,colorSpace:e.outputColorSpace,samples:_.antialias?4:0,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}else{let n={antialias:_.antialias,alpha:!0,depth:_.depth,stencil:_.stencil,framebufferScaleFactor:i};f=new XRWebGLLayer(r,t,n),r.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),y=new zd(f.framebufferWidth,f.framebufferHeight,{format:kl,type:ml,colorSpace:e.outputColorSpace,stencilBuffer:_.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}y.isXRRenderTarget=!0,this.setFoveation(s),c=null,a=await r.requestReferenceSpace(o),ie.setContext(r),ie.start(),n.isPresenting=!0,n.dispatchEvent({type:`sessionstart`})}},this.getEnvironmentBlendMode=function(){if(r!==null)return r.environmentBlendMode},this.getDepthTexture=function(){return h.getDepthTexture()};function M(e){for(let t=0;t<e.removed.length;t++){let n=e.removed[t],r=x.indexOf(n);r>=0&&(x[r]=null,b[r].disconnect(n))}for(let t=0;t<e.added.length;t++){let n=e.added[t],r=x.indexOf(n);if(r===-1){for(let e=0;e<b.length;e++)if(e>=x.length){x.push(n),r=e;break}else if(x[e]===null){x[e]=n,r=e;break}if(r===-1)break}let i=b[r];i&&i.connect(n)}}function te(e,t){t===null?e.matrixWorld.copy(e.matrix):e.matrixWorld.multiplyMatrices(t.matrixWorld,e.matrix),e.matrixWorldInverse.copy(e.matrixWorld).invert()}this.updateCamera=function(e){if(r===null)return;let t=e.near,n=e.far;h.texture!==null&&(h.depthNear>0&&(t=h.depthNear),h.depthFar>0&&(n=h.depthFar)),O.near=E.near=T.near=t,O.far=E.far=T.far=n,(k!==O.near||A!==O.far)&&(r.updateRenderState({depthNear:O.near,depthFar:O.far}),k=O.near,A=O.far),O.layers.mask=e.layers.mask|6,T.layers.mask=O.layers.mask&-5,E.layers.mask=O.layers.mask&-3;let i=e.parent,a=O.cameras;te(O,i);for(let e=0;e<a.length;e++)te(a[e],i);O.projectionMatrix.copy(T.projectionMatrix),O.projectionMatrixInverse.copy(T.projectionMatrixInverse),w===null&&e.isPerspectiveCamera&&(w={camera:e,fov:e.fov,zoom:e.zoom}),ne(e,O,i)};function ne(e,t,n){n===null?e.matrix.copy(t.matrixWorld):(e.matrix.copy(n.matrixWorld),e.matrix.invert(),e.matrix.multiply(t.matrixWorld)),e.matrix.decompose(e.position,e.quaternion,e.scale),e.updateMatrixWorld(!0),e.projectionMatrix.copy(t.projectionMatrix),e.projectionMatrixInverse.copy(t.projectionMatrixInverse),e.isPerspectiveCamera&&(e.fov=Yu*2*Math.atan(1/e.projectionMatrix.elements[5]),e.zoom=1)}this.getCamera=function(){return O},this.getFoveation=function(){if(d!==null||f!==null)return s},this.setFoveation=function(e){s=e,d!==null&&(d.fixedFoveation=e),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=e)},this.hasDepthSensing=function(){return h.texture!==null},this.getDepthSensingMesh=function(){return h.getMesh(O)},this.getCameraTexture=function(e){return g[e]};let N=null;function re(t,i){if(l=i.getViewerPose(c||a),p=i,l!==null){let t=l.views;f!==null&&(e.setRenderTargetFramebuffer(y,f.framebuffer),e.setRenderTarget(y));let i=!1;t.length!==O.cameras.length&&(O.cameras.length=0,i=!0);for(let n=0;n<t.length;n++){let r=t[n],a=null;if(f!==null)a=f.getViewport(r);else{let t=u.getViewSubImage(d,r);a=t.viewport,n===0&&(e.setRenderTargetTextures(y,t.colorTexture,t.depthStencilTexture),e.setRenderTarget(y))}let o=D[n];o===void 0&&(o=new nh,o.layers.enable(n),o.viewport=new Ld,D[n]=o),o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.projectionMatrix.fromArray(r.projectionMatrix),o.projectionMatrixInverse.copy(o.projectionMatrix).invert(),o.viewport.set(a.x,a.y,a.width,a.height),n===0&&(O.matrix.copy(o.matrix),O.matrix.decompose(O.position,O.quaternion,O.scale)),i===!0&&O.cameras.push(o)}let a=r.enabledFeatures;if(a&&a.includes(`depth-sensing`)&&r.depthUsage==`gpu-optimized`&&m){u=n.getBinding();let e=u.getDepthInformation(t[0]);e&&e.isValid&&e.texture&&h.init(e,r.renderState)}if(a&&a.includes(`camera-access`)&&m){e.state.unbindTexture(),u=n.getBinding();for(let e=0;e<t.length;e++){let n=t[e].camera;if(n){let e=g[n];e||(e=new fm,g[n]=e);let t=u.getCameraImage(n);e.sourceTexture=t}}}}for(let e=0;e<b.length;e++){let t=x[e],n=b[e];t!==null&&n!==void 0&&n.update(t,i,c||a)}N&&N(t,i),i.detectedPlanes&&n.dispatchEvent({type:`planesdetected`,data:i}),p=null}let ie=new wh;ie.setAnimationLoop(re),this.setAnimationLoop=function(e){N=e},this.dispose=function(){}}},Ev=new Hd,Dv=new Z;Dv.set(-1,0,0,0,1,0,0,0,1);function Ov(e,t){function n(e,t){e.matrixAutoUpdate===!0&&e.updateMatrix(),t.value.copy(e.matrix)}function r(t,n){n.color.getRGB(t.fogColor.value,xm(e)),n.isFog?(t.fogNear.value=n.near,t.fogFar.value=n.far):n.isFogExp2&&(t.fogDensity.value=n.density)}function i(e,t,n,r,i){t.isNodeMaterial?t.uniformsNeedUpdate=!1:t.isMeshBasicMaterial?a(e,t):t.isMeshLambertMaterial?(a(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshToonMaterial?(a(e,t),d(e,t)):t.isMeshPhongMaterial?(a(e,t),u(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshStandardMaterial?(a(e,t),f(e,t),t.isMeshPhysicalMaterial&&p(e,t,i)):t.isMeshMatcapMaterial?(a(e,t),m(e,t)):t.isMeshDepthMaterial?a(e,t):t.isMeshDistanceMaterial?(a(e,t),h(e,t)):t.isMeshNormalMaterial?a(e,t):t.isLineBasicMaterial?(o(e,t),t.isLineDashedMaterial&&s(e,t)):t.isPointsMaterial?c(e,t,n,r):t.isSpriteMaterial?l(e,t):t.isShadowMaterial?(e.color.value.copy(t.color),e.opacity.value=t.opacity):t.isShaderMaterial&&(t.uniformsNeedUpdate=!1)}function a(e,r){e.opacity.value=r.opacity,r.color&&e.diffuse.value.copy(r.color),r.emissive&&e.emissive.value.copy(r.emissive).multiplyScalar(r.emissiveIntensity),r.map&&(e.map.value=r.map,n(r.map,e.mapTransform)),r.alphaMap&&(e.alphaMap.value=r.alphaMap,n(r.alphaMap,e.alphaMapTransform)),r.bumpMap&&(e.bumpMap.value=r.bumpMap,n(r.bumpMap,e.bumpMapTransform),e.bumpScale.value=r.bumpScale,r.side===1&&(e.bumpScale.value*=-1)),r.normalMap&&(e.normalMap.value=r.normalMap,n(r.normalMap,e.normalMapTransform),e.normalScale.value.copy(r.normalScale),r.side===1&&e.normalScale.value.negate()),r.displacementMap&&(e.displacementMap.value=r.displacementMap,n(r.displacementMap,e.displacementMapTransform),e.displacementScale.value=r.displacementScale,e.displacementBias.value=r.displacementBias),r.emissiveMap&&(e.emissiveMap.value=r.emissiveMap,n(r.emissiveMap,e.emissiveMapTransform)),r.specularMap&&(e.specularMap.value=r.specularMap,n(r.specularMap,e.specularMapTransform)),r.alphaTest>0&&(e.alphaTest.value=r.alphaTest);let i=t.get(r),a=i.envMap,o=i.envMapRotation;a&&(e.envMap.value=a,e.envMapRotation.value.setFromMatrix4(Ev.makeRotationFromEuler(o)).transpose(),a.isCubeTexture&&a.isRenderTargetTexture===!1&&e.envMapRotation.value.premultiply(Dv),e.reflectivity.value=r.reflectivity,e.ior.value=r.ior,e.refractionRatio.value=r.refractionRatio),r.lightMap&&(e.lightMap.value=r.lightMap,e.lightMapIntensity.value=r.lightMapIntensity,n(r.lightMap,e.lightMapTransform)),r.aoMap&&(e.aoMap.value=r.aoMap,e.aoMapIntensity.value=r.aoMapIntensity,n(r.aoMap,e.aoMapTransform))}function o(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform))}function s(e,t){e.dashSize.value=t.dashSize,e.totalSize.value=t.dashSize+t.gapSize,e.scale.value=t.scale}function c(e,t,r,i){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.size.value=t.size*r,e.scale.value=i*.5,t.map&&(e.map.value=t.map,n(t.map,e.uvTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function l(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.rotation.value=t.rotation,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function u(e,t){e.specular.value.copy(t.specular),e.shininess.value=Math.max(t.shininess,1e-4)}function d(e,t){t.gradientMap&&(e.gradientMap.value=t.gradientMap)}function f(e,t){e.metalness.value=t.metalness,t.metalnessMap&&(e.metalnessMap.value=t.metalnessMap,n(t.metalnessMap,e.metalnessMapTransform)),e.roughness.value=t.roughness,t.roughnessMap&&(e.roughnessMap.value=t.roughnessMap,n(t.roughnessMap,e.roughnessMapTransform)),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)}function p(e,t,r){e.ior.value=t.ior,t.diffuseRoughness>0&&(e.diffuseRoughness.value=t.diffuseRoughness,t.diffuseRoughnessMap&&(e.diffuseRoughnessMap.value=t.diffuseRoughnessMap,n(t.diffuseRoughnessMap,e.diffuseRoughnessMapTransform))),t.sheen>0&&(e.sheenColor.value.copy(t.sheenColor).multiplyScalar(t.sheen),e.sheenRoughness.value=t.sheenRoughness,t.sheenColorMap&&(e.sheenColorMap.value=t.sheenColorMap,n(t.sheenColorMap,e.sheenColorMapTransform)),t.sheenRoughnessMap&&(e.sheenRoughnessMap.value=t.sheenRoughnessMap,n(t.sheenRoughnessMap,e.sheenRoughnessMapTransform))),t.clearcoat>0&&(e.clearcoat.value=t.clearcoat,e.clearcoatRoughness.value=t.clearcoatRoughness,t.clearcoatMap&&(e.clearcoatMap.value=t.clearcoatMap,n(t.clearcoatMap,e.clearcoatMapTransform)),t.clearcoatRoughnessMap&&(e.clearcoatRoughnessMap.value=t.clearcoatRoughnessMap,n(t.clearcoatRoughnessMap,e.clearcoatRoughnessMapTransform)),t.clearcoatNormalMap&&(e.clearcoatNormalMap.value=t.clearcoatNormalMap,n(t.clearcoatNormalMap,e.clearcoatNormalMapTransform),e.clearcoatNormalScale.value.copy(t.clearcoatNormalScale),t.side===1&&e.clearcoatNormalScale.value.negate())),t.dispersion>0&&(e.dispersion.value=t.dispersion),t.retroreflectivity>0&&(e.retroreflectivity.value=t.retroreflectivity),t.iridescence>0&&(e.iridescence.value=t.iridescence,e.iridescenceIOR.value=t.iridescenceIOR,e.iridescenceThicknessMinimum.value=t.iridescenceThicknessMinimum,e.iridescenceThicknessMaximum.value=t.iridescenceThicknessMaximum,t.iridescenceMap&&(e.iridescenceMap.value=t.iridescenceMap,n(t.iridescenceMap,e.iridescenceMapTransform)),t.iridescenceThicknessMap&&(e.iridescenceThicknessMap.value=t.iridescenceThicknessMap,n(t.iridescenceThicknessMap,e.iridescenceThicknessMapTransform))),t.transmission>0&&(e.transmission.value=t.transmission,e.transmissionSamplerMap.value=r.texture,e.transmissionSamplerSize.value.set(r.width,r.height),t.transmissionMap&&(e.transmissionMap.value=t.transmissionMap,n(t.transmissionMap,e.transmissionMapTransform)),e.thickness.value=t.thickness,t.thicknessMap&&(e.thicknessMap.value=t.thicknessMap,n(t.thicknessMap,e.thicknessMapTransform)),e.attenuationDistance.value=t.attenuationDistance,e.attenuationColor.value.copy(t.attenuationColor)),t.anisotropy>0&&(e.anisotropyVector.value.set(t.anisotropy*Math.cos(t.anisotropyRotation),t.anisotropy*Math.sin(t.anisotropyRotation)),t.anisotropyMap&&(e.anisotropyMap.value=t.anisotropyMap,n(t.anisotropyMap,e.anisotropyMapTransform))),e.specularIntensity.value=t.specularIntensity,e.specularColor.value.copy(t.specularColor),t.specularColorMap&&(e.specularColorMap.value=t.specularColorMap,n(t.specularColorMap,e.specularColorMapTransform)),t.specularIntensityMap&&(e.specularIntensityMap.value=t.specularIntensityMap,n(t.specularIntensityMap,e.specularIntensityMapTransform))}function m(e,t){t.matcap&&(e.matcap.value=t.matcap)}function h(e,n){let r=t.get(n).light;e.referencePosition.value.setFromMatrixPosition(r.matrixWorld),e.nearDistance.value=r.shadow.camera.near,e.farDistance.value=r.shadow.camera.far}return{refreshFogUniforms:r,refreshMaterialUniforms:i}}function kv(e,t,n,r){let i={},a={};function o(e,t){let n=t.program;r.uniformBlockBinding(e,n,i[e.id])}function s(e,n){let o=i[e.id];o===void 0&&(m(e),o=c(e),i[e.id]=o,e.addEventListener(`dispose`,g));let s=n.program;r.updateUBOMapping(e,s);let u=t.render.frame;a[e.id]!==u&&(l(e),a[e.id]=u)}function c(t){let n=e.createBuffer(),r=t.__size,i=t.usage;return e.bindBuffer(e.UNIFORM_BUFFER,n),e.bufferData(e.UNIFORM_BUFFER,r,i),e.bindBuffer(e.UNIFORM_BUFFER,null),n}function l(t){let n=i[t.id],r=t.uniforms,a=t.__cache;e.bindBuffer(e.UNIFORM_BUFFER,n);for(let e=0,t=r.length;e<t;e++){let t=r[e];if(Array.isArray(t))for(let n=0,r=t.length;n<r;n++)u(t[n],e,n,a);else u(t,e,0,a)}e.bindBuffer(e.UNIFORM_BUFFER,null)}function u(t,n,r,i){if(f(t,n,r,i)===!0){let n=t.__offset,r=t.value;if(Array.isArray(r)){let e=0;for(let n=0;n<r.length;n++){let i=r[n],a=h(i,!0);d(i,t.__data,e),e+=a.storage/Float32Array.BYTES_PER_ELEMENT}}else d(r,t.__data,0);e.bufferSubData(e.UNIFORM_BUFFER,n,t.__data)}}function d(e,t,n){typeof e==`number`||typeof e==`boolean`?t[n]=e:e.isMatrix3?(t[n]=e.elements[0],t[n+1]=e.elements[1],t[n+2]=e.elements[2],t[n+3]=0,t[n+4]=e.elements[3],t[n+5]=e.elements[4],t[n+6]=e.elements[5],t[n+7]=0,t[n+8]=e.elements[6],t[n+9]=e.elements[7],t[n+10]=e.elements[8],t[n+11]=0):ArrayBuffer.isView(e)?t.set(e.subarray(0,t.length-n),n):e.toArray(t,n)}function f(e,t,n,r){let i=e.value,a=t+`_`+n;if(Array.isArray(i)){r[a]===void 0&&(r[a]=[]);let e=r[a],t=!1;for(let n=0;n<i.length;n++)p(i[n],e,n)===!0&&(t=!0);return t}return p(i,r,a)}function p(e,t,n){if(t[n]===void 0)return t[n]=typeof e==`number`||typeof e==`boolean`?e:ArrayBuffer.isView(e)?e.slice():e.clone(),!0;{let r=t[n];if(typeof e==`number`||typeof e==`boolean`){if(r!==e)return t[n]=e,!0}else if(ArrayBuffer.isView(e))return!0;else if(r.equals(e)===!1)return r.copy(e),!0}return!1}function m(e){let t=e.uniforms,n=0;for(let e=0,r=t.length;e<r;e++){let r=Array.isArray(t[e])?t[e]:[t[e]];for(let i=0,a=r.length;i<a;i++){let a=r[i],o=Array.isArray(a.value)?a.value:[a.value],s=Array.isArray(t[e])||Array.isArray(a.value),c=n;for(let e=0,t=o.length;e<t;e++){let t=o[e],r=h(t,s),i=n%16,a=i%r.boundary,l=i+a;n+=a,l!==0&&16-l<r.storage&&(n+=16-l),e===0&&(c=n),n+=r.storage}a.__data=new(a.type===`int`?Int32Array:a.type===`uint`?Uint32Array:Float32Array)((n-c)/Float32Array.BYTES_PER_ELEMENT),a.__offset=c}}let r=n%16;return r>0&&(n+=16-r),e.__size=n,e.__cache={},this}function h(e,t){let n={boundary:0,storage:0};return typeof e==`number`||typeof e==`boolean`?(n.boundary=4,n.storage=4):e.isVector2?(n.boundary=8,n.storage=8):e.isVector3||e.isColor?(n.boundary=16,n.storage=12):e.isVector4?(n.boundary=16,n.storage=16):e.isMatrix3?(n.boundary=16,n.storage=48):e.isMatrix4?(n.boundary=16,n.storage=64):e.isTexture?K(`WebGLRenderer: Texture samplers can not be part of an uniforms group.`):ArrayBuffer.isView(e)?(n.boundary=16,n.storage=e.byteLength):K(`WebGLRenderer: Unsupported uniform value type.`,e),t===!0&&(n.boundary=16,n.storage=Math.ceil(n.storage/16)*16),n}function g(t){let n=t.target;n.removeEventListener(`dispose`,g),e.deleteBuffer(i[n.id]),delete i[n.id],delete a[n.id]}function _(){for(let t in i)e.deleteBuffer(i[t]);i={},a={}}return{bind:o,update:s,dispose:_}}var Av=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),jv=null;function Mv(){return jv===null&&(jv=new qp(Av,16,16,Pl,xl),jv.name=`DFG_LUT`,jv.minFilter=dl,jv.magFilter=dl,jv.wrapS=ol,jv.wrapT=ol,jv.generateMipmaps=!1,jv.needsUpdate=!0),jv}var Nv=class{constructor(e={}){let{canvas:t=Ru(),context:n=null,depth:r=!0,stencil:i=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:s=!0,preserveDrawingBuffer:c=!1,powerPreference:l=`default`,failIfMajorPerformanceCaveat:u=!1,reversedDepthBuffer:d=!1,outputBufferType:f=ml}=e;this.isWebGLRenderer=!0;let p;if(n!==null){if(typeof WebGLRenderingContext<`u`&&n instanceof WebGLRenderingContext)throw Error(`THREE.WebGLRenderer: WebGL 1 is not supported since r163.`);p=n.getContextAttributes().alpha}else p=a;let m=f,h=new Set([Il,Fl,Nl]),g=new Set([ml,yl,_l,wl,Sl,Cl]),_=new Uint32Array(4),v=new Int32Array(4),y={textures:[],min:[],max:[],resolution:[]},b=null,x=null,S=[],C=[],w=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=0,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let T=this,E=!1,D=null,O=null,k=null,A=null;this._outputColorSpace=Du;let j=0,ee=0,M=null,te=-1,ne=null,N=new Ld,re=new Ld,ie=null,ae=new wf(0),oe=0,se=t.width,ce=t.height,le=1,ue=null,de=null,fe=new Ld(0,0,se,ce),pe=new Ld(0,0,se,ce),me=!1,he=new om,ge=new cm,_e=!1,ve=!1,ye=new Hd,be=new X,xe=new Ld,Se={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},Ce=!1;function we(){return M===null?le:1}let P=n;function Te(e,n){return t.getContext(e,n)}let Ee,De,F,I,L,R,Oe,ke,Ae,je,Me,Ne,Pe,Fe,Ie,Le,Re,ze,Be,Ve,He,Ue,We;try{let e={alpha:!0,depth:r,stencil:i,antialias:o,premultipliedAlpha:s,preserveDrawingBuffer:c,powerPreference:l,failIfMajorPerformanceCaveat:u};if(`setAttribute`in t&&t.setAttribute(`data-engine`,`three.js r187`),t.addEventListener(`webglcontextlost`,qe,!1),t.addEventListener(`webglcontextrestored`,Je,!1),t.addEventListener(`webglcontextcreationerror`,Ye,!1),P===null){let t=`webgl2`;if(P=Te(t,e),P===null)throw Te(t)?Error(`THREE.WebGLRenderer: Error creating WebGL context with your selected attributes.`):Error(`THREE.WebGLRenderer: Error creating WebGL context.`)}Ge()}catch(e){throw t.removeEventListener(`webglcontextlost`,qe,!1),t.removeEventListener(`webglcontextrestored`,Je,!1),t.removeEventListener(`webglcontextcreationerror`,Ye,!1),q(`WebGLRenderer: `+e.message),e}function Ge(){Ee=new $h(P),Ee.init(),He=new xv(P,Ee),De=new Nh(P,Ee,e,He),F=new yv(P,Ee),De.reversedDepthBuffer&&d&&F.buffers.depth.setReversed(!0),O=P.createFramebuffer(),k=P.createFramebuffer(),A=P.createFramebuffer(),I=new ng(P),L=new $_,R=new bv(P,Ee,F,L,De,He,I),Oe=new Qh(T),ke=new Th(P),Ue=new jh(P,ke),Ae=new eg(P,ke,I,Ue),je=new ig(P,Ae,ke,Ue,I),ze=new rg(P,De,R),Ie=new Ph(L),Me=new Q_(T,Oe,Ee,De,Ue,Ie),Ne=new Ov(T,L),Pe=new rv,Fe=new uv(Ee),Re=new Ah(T,Oe,F,je,p,s),Le=new vv(T,je,De),We=new kv(P,I,De,F),Be=new Mh(P,Ee,I),Ve=new tg(P,Ee,I),I.programs=Me.programs,T.capabilities=De,T.extensions=Ee,T.properties=L,T.renderLists=Pe,T.shadowMap=Le,T.state=F,T.info=I}m!==1009&&(w=new og(m,t.width,t.height,o,r,i));let Ke=new Tv(T,P);this.xr=Ke,this.getContext=function(){return P},this.getContextAttributes=function(){return P.getContextAttributes()},this.forceContextLoss=function(){let e=Ee.get(`WEBGL_lose_context`);e&&e.loseContext()},this.forceContextRestore=function(){let e=Ee.get(`WEBGL_lose_context`);e&&e.restoreContext()},this.getPixelRatio=function(){return le},this.setPixelRatio=function(e){e!==void 0&&(le=e,this.setSize(se,ce,!1))},this.getSize=function(e){return e.set(se,ce)},this.setSize=function(e,n,r=!0){Ke.isPresenting?K(`WebGLRenderer: Can't change size while VR device is presenting.`):(se=e,ce=n,t.width=Math.floor(e*le),t.height=Math.floor(n*le),r===!0&&(t.style.width=e+`px`,t.style.height=n+`px`),w!==null&&w.setSize(t.width,t.height),this.setViewport(0,0,e,n))},this.getDrawingBufferSize=function(e){return e.set(se*le,ce*le).floor()},this.setDrawingBufferSize=function(e,n,r){se=e,ce=n,le=r,t.width=Math.floor(e*r),t.height=Math.floor(n*r),this.setViewport(0,0,e,n)},this.setEffects=function(e){if(m===1009)q(`WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.`);else{if(e){for(let t=0;t<e.length;t++)if(e[t].isOutputPass===!0){K(`WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.`);break}}w.setEffects(e||[])}},this.getCurrentViewport=function(e){return e.copy(N)},this.getViewport=function(e){return e.copy(fe)},this.setViewport=function(e,t,n,r){e.isVector4?fe.set(e.x,e.y,e.z,e.w):fe.set(e,t,n,r),F.viewport(N.copy(fe).multiplyScalar(we()).round())},this.getScissor=function(e){return e.copy(pe)},this.setScissor=function(e,t,n,r){e.isVector4?pe.set(e.x,e.y,e.z,e.w):pe.set(e,t,n,r),F.scissor(re.copy(pe).multiplyScalar(we()).round())},this.getScissorTest=function(){return me},this.setScissorTest=function(e){F.setScissorTest(me=e)},this.setOpaqueSort=function(e){ue=e},this.setTransparentSort=function(e){de=e},this.getClearColor=function(e){return e.copy(Re.getClearColor())},this.setClearColor=function(){Re.setClearColor(...arguments)},this.getClearAlpha=function(){return Re.getClearAlpha()},this.setClearAlpha=function(){Re.setClearAlpha(...arguments)},this.clear=function(e=!0,t=!0,n=!0){let r=0;if(e){let e=!1;if(M!==null){let t=M.texture.format;e=h.has(t)}if(e){let e=M.texture.type,t=g.has(e),n=Re.getClearColor(),r=Re.getClearAlpha(),i=n.r,a=n.g,o=n.b;t?(_[0]=i,_[1]=a,_[2]=o,_[3]=r,P.clearBufferuiv(P.COLOR,0,_)):(v[0]=i,v[1]=a,v[2]=o,v[3]=r,P.clearBufferiv(P.COLOR,0,v))}else r|=P.COLOR_BUFFER_BIT}t&&(r|=P.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),n&&(r|=P.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),r!==0&&P.clear(r)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(e){e.setRenderer(this),D=e},this.dispose=function(){t.removeEventListener(`webglcontextlost`,qe,!1),t.removeEventListener(`webglcontextrestored`,Je,!1),t.removeEventListener(`webglcontextcreationerror`,Ye,!1),Re.dispose(),Pe.dispose(),Fe.dispose(),R.dispose(),L.dispose(),Oe.dispose(),je.dispose(),Ae.dispose(),Ue.dispose(),We.dispose(),Me.dispose(),Ke.dispose(),Ke.removeEventListener(`sessionstart`,tt),Ke.removeEventListener(`sessionend`,nt),rt.stop()};function qe(e){e.preventDefault(),Bu(`WebGLRenderer: Context Lost.`),E=!0}function Je(){Bu(`WebGLRenderer: Context Restored.`),E=!1;let e=I.autoReset,t=Le.enabled,n=Le.autoUpdate,r=Le.needsUpdate,i=Le.type;Ge(),I.autoReset=e,Le.enabled=t,Le.autoUpdate=n,Le.needsUpdate=r,Le.type=i}function Ye(e){q(`WebGLRenderer: A WebGL context could not be created. Reason: `,e.statusMessage)}function Xe(e){let t=e.target;t.removeEventListener(`dispose`,Xe),Ze(t)}function Ze(e){Qe(e),L.remove(e)}function Qe(e){let t=L.get(e).programs;t!==void 0&&(t.forEach(function(e){Me.releaseProgram(e)}),e.isShaderMaterial&&Me.releaseShaderCache(e))}this.renderBufferDirect=function(e,t,n,r,i,a){t===null&&(t=Se);let o=i.isMesh&&i.matrixWorld.determinantAffine()<0,s=pt(e,t,n,r,i);F.setMaterial(r,o);let c=n.index,l=1;if(r.wireframe===!0){if(c=Ae.getWireframeAttribute(n),c===void 0)return;l=2}let u=n.drawRange,d=n.attributes.position,f=u.start*l,p=(u.start+u.count)*l;a!==null&&(f=Math.max(f,a.start*l),p=Math.min(p,(a.start+a.count)*l)),c===null?d!=null&&(f=Math.max(f,0),p=Math.min(p,d.count)):(f=Math.max(f,0),p=Math.min(p,c.count));let m=p-f;if(m<0||m===1/0)return;Ue.setup(i,r,s,n,c);let h,g=Be;if(c!==null&&(h=ke.get(c),g=Ve,g.setIndex(h)),i.isMesh)r.wireframe===!0?(F.setLineWidth(r.wireframeLinewidth*we()),g.setMode(P.LINES)):g.setMode(P.TRIANGLES);else if(i.isLine){let e=r.linewidth;e===void 0&&(e=1),F.setLineWidth(e*we()),i.isLineSegments?g.setMode(P.LINES):i.isLineLoop?g.setMode(P.LINE_LOOP):g.setMode(P.LINE_STRIP)}else i.isPoints?g.setMode(P.POINTS):i.isSprite&&g.setMode(P.TRIANGLES);if(i.isBatchedMesh){if(Ee.get(`WEBGL_multi_draw`))g.renderMultiDraw(i._multiDrawStarts,i._multiDrawCounts,i._multiDrawCount);else{let e=i._multiDrawStarts,t=i._multiDrawCounts,n=i._multiDrawCount,a=c?ke.get(c).bytesPerElement:1,o=L.get(r).currentProgram.getUniforms();for(let r=0;r<n;r++)o.setValue(P,`_gl_DrawID`,r),g.render(e[r]/a,t[r])}}else if(i.isInstancedMesh)g.renderInstances(f,m,i.count);else if(n.isInstancedBufferGeometry){let e=n._maxInstanceCount===void 0?1/0:n._maxInstanceCount,t=Math.min(n.instanceCount,e);g.renderInstances(f,m,t)}else g.render(f,m)};function $e(e,t,n,r){D!==null&&e.isNodeMaterial&&D.setObject(r,e),_e===!0&&Ie.setState(e,n,!1),e.transparent===!0&&e.side===2&&e.forceSinglePass===!1?(e.side=1,e.needsUpdate=!0,lt(e,t,r),e.side=0,e.needsUpdate=!0,lt(e,t,r),e.side=2):lt(e,t,r)}this.compile=function(e,t,n=null){n===null&&(n=e),D!==null&&D.renderStart(e,t,n),x=Fe.get(n),x.init(t),C.push(x),n.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),e!==n&&e.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),x.setupLights(),D!==null&&D.updateLights(x.state.lightsArray),ve=this.localClippingEnabled,_e=Ie.init(this.clippingPlanes,ve),_e===!0&&Ie.setGlobalState(this.clippingPlanes,t),D!==null&&Le.render(x.state.shadowsArray,n,t);let r=new Set;return e.traverse(function(e){if(!(e.isMesh||e.isPoints||e.isLine||e.isSprite))return;let i=e.material;if(i){if(Array.isArray(i))for(let a=0;a<i.length;a++){let o=i[a];$e(o,n,t,e),r.add(o)}else $e(i,n,t,e),r.add(i)}}),x=C.pop(),D!==null&&D.renderEnd(),r},this.compileAsync=function(e,t,n=null){let r=this.compile(e,t,n);return new Promise(t=>{function n(){r.forEach(function(e){let t=L.get(e).currentProgram;(t===void 0||t.isReady())&&r.delete(e)}),r.size===0?t(e):setTimeout(n,10)}Ee.get(`KHR_parallel_shader_compile`)===null?setTimeout(n,10):n()})};let z=null;function et(e){z&&z(e)}function tt(){rt.stop()}function nt(){rt.start()}let rt=new wh;rt.setAnimationLoop(et),typeof self<`u`&&rt.setContext(self),this.setAnimationLoop=function(e){z=e,Ke.setAnimationLoop(e),e===null?rt.stop():rt.start()},Ke.addEventListener(`sessionstart`,tt),Ke.addEventListener(`sessionend`,nt),this.render=function(e,t){if(t!==void 0&&t.isCamera!==!0){q(`WebGLRenderer.render: camera is not an instance of THREE.Camera.`);return}if(E===!0)return;D!==null&&D.renderStart(e,t);let n=Ke.enabled===!0&&Ke.isPresenting===!0,r=w!==null&&(M===null||n)&&w.begin(T,M);if(e.matrixWorldAutoUpdate===!0&&e.updateMatrixWorld(),t.parent===null&&t.matrixWorldAutoUpdate===!0&&t.updateMatrixWorld(),Ke.enabled===!0&&Ke.isPresenting===!0&&(w===null||w.isCompositing()===!1)&&(Ke.cameraAutoUpdate===!0&&Ke.updateCamera(t),t=Ke.getCamera()),e.isScene===!0&&e.onBeforeRender(T,e,t,M),x=Fe.get(e,C.length),x.init(t),x.state.textureUnits=R.getTextureUnits(),C.push(x),ye.multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse),t.isArrayCamera?ge.setFromArrayCamera(t):he.setFromProjectionMatrix(ye,Pu,t.reversedDepth),ve=this.localClippingEnabled,_e=Ie.init(this.clippingPlanes,ve),b=Pe.get(e,S.length),b.init(),S.push(b),this.info.render.frame++,Ke.enabled===!0&&Ke.isPresenting===!0){let e=T.xr.getDepthSensingMesh();e!==null&&B(e,t,-1/0,T.sortObjects)}B(e,t,0,T.sortObjects),b.finish(),D!==null&&D.updateLights(x.state.lightsArray),T.sortObjects===!0&&b.sort(ue,de),Ce=Ke.enabled===!1||Ke.isPresenting===!1||Ke.hasDepthSensing()===!1,Ce&&Re.addToRenderList(b,e),this.info.autoReset===!0&&this.info.reset(),_e===!0&&Ie.beginShadows();let i=x.state.shadowsArray;if(Le.render(i,e,t),_e===!0&&Ie.endShadows(),(r&&w.hasRenderPass())===!1){let n=b.opaque,r=b.transmissive;if(x.setupLights(),t.isArrayCamera){let i=t.cameras;if(r.length>0)for(let t=0,a=i.length;t<a;t++){let a=i[t];at(n,r,e,a)}Ce&&Re.render(e);for(let t=0,n=i.length;t<n;t++){let n=i[t];it(b,e,n,n.viewport)}}else r.length>0&&at(n,r,e,t),Ce&&Re.render(e),it(b,e,t)}M!==null&&ee===0&&(R.updateMultisampleRenderTarget(M),R.updateRenderTargetMipmap(M)),r&&w.end(T),e.isScene===!0&&e.onAfterRender(T,e,t),Ue.resetDefaultState(),te=-1,ne=null,C.pop(),C.length>0?(x=C[C.length-1],R.setTextureUnits(x.state.textureUnits),_e===!0&&Ie.setGlobalState(T.clippingPlanes,x.state.camera)):x=null,S.pop(),b=S.length>0?S[S.length-1]:null,D!==null&&D.renderEnd()};function B(e,t,n,r){if(e.visible===!1)return;if(e.layers.test(t.layers)){if(e.isGroup)n=e.renderOrder;else if(e.isLOD)e.autoUpdate===!0&&e.update(t);else if(e.isLight)x.pushLight(e),e.castShadow&&x.pushShadow(e);else if(e.isSprite){let i=t.isArrayCamera?ge:he;if(!e.frustumCulled||e.intersectsFrustum(i)){r&&xe.setFromMatrixPosition(e.matrixWorld).applyMatrix4(ye);let i=je.update(e),a=e.material;a.visible&&b.push(e,i,a,n,xe.z,null,t)}}else if(e.isMesh||e.isLine||e.isPoints){let i=t.isArrayCamera?ge:he;if(!e.frustumCulled||e.intersectsFrustum(i)){let i=je.update(e),a=e.material;if(r&&(e.boundingSphere===void 0?(i.boundingSphere===null&&i.computeBoundingSphere(),xe.copy(i.boundingSphere.center)):(e.boundingSphere===null&&e.computeBoundingSphere(),xe.copy(e.boundingSphere.center)),xe.applyMatrix4(e.matrixWorld).applyMatrix4(ye)),Array.isArray(a)){let r=i.groups;for(let o=0,s=r.length;o<s;o++){let s=r[o],c=a[s.materialIndex];c&&c.visible&&b.push(e,i,c,n,xe.z,s,t)}}else a.visible&&b.push(e,i,a,n,xe.z,null,t)}}}let i=e.children;for(let e=0,a=i.length;e<a;e++)B(i[e],t,n,r)}function it(e,t,n,r){let{opaque:i,transmissive:a,transparent:o}=e;x.setupLightsView(n),_e===!0&&Ie.setGlobalState(T.clippingPlanes,n),r&&F.viewport(N.copy(r)),i.length>0&&ot(i,t,n),a.length>0&&ot(a,t,n),o.length>0&&ot(o,t,n),F.buffers.depth.setTest(!0),F.buffers.depth.setMask(!0),F.buffers.color.setMask(!0),F.setPolygonOffset(!1)}function at(e,t,n,r){if((n.isScene===!0?n.overrideMaterial:null)!==null)return;if(x.state.transmissionRenderTarget[r.id]===void 0){let e=Ee.has(`EXT_color_buffer_half_float`)||Ee.has(`EXT_color_buffer_float`);x.state.transmissionRenderTarget[r.id]=new zd(1,1,{generateMipmaps:!0,type:e?xl:ml,minFilter:pl,samples:Math.max(4,De.samples),stencilBuffer:i,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Ed.workingColorSpace})}let a=x.state.transmissionRenderTarget[r.id],o=r.viewport||N;a.setSize(o.z*T.transmissionResolutionScale,o.w*T.transmissionResolutionScale);let s=T.getRenderTarget(),c=T.getActiveCubeFace(),l=T.getActiveMipmapLevel();T.setRenderTarget(a),T.getClearColor(ae),oe=T.getClearAlpha(),oe<1&&T.setClearColor(16777215,.5),T.clear(),Ce&&Re.render(n);let u=T.toneMapping;T.toneMapping=0;let d=r.viewport;if(r.viewport!==void 0&&(r.viewport=void 0),x.setupLightsView(r),_e===!0&&Ie.setGlobalState(T.clippingPlanes,r),ot(e,n,r),R.updateMultisampleRenderTarget(a),R.updateRenderTargetMipmap(a),Ee.has(`WEBGL_multisampled_render_to_texture`)===!1){let e=!1;for(let i=0,a=t.length;i<a;i++){let{object:a,geometry:o,material:s,group:c}=t[i];if(s.side===2&&a.layers.test(r.layers)){let t=s.side;s.side=1,s.needsUpdate=!0,st(a,n,r,o,s,c),s.side=t,s.needsUpdate=!0,e=!0}}e===!0&&(R.updateMultisampleRenderTarget(a),R.updateRenderTargetMipmap(a))}T.setRenderTarget(s,c,l),T.setClearColor(ae,oe),d!==void 0&&(r.viewport=d),T.toneMapping=u}function ot(e,t,n){let r=t.isScene===!0?t.overrideMaterial:null;for(let i=0,a=e.length;i<a;i++){let a=e[i],{object:o,geometry:s,group:c}=a,l=a.material;l.allowOverride===!0&&r!==null&&(l=r),o.layers.test(n.layers)&&st(o,t,n,s,l,c)}}function st(e,t,n,r,i,a){D!==null&&i.isNodeMaterial&&D.setObject(e,i),e.onBeforeRender(T,t,n,r,i,a),e.modelViewMatrix.multiplyMatrices(n.matrixWorldInverse,e.matrixWorld),e.normalMatrix.getNormalMatrix(e.modelViewMatrix),i.onBeforeRender(T,t,n,r,e,a),i.transparent===!0&&i.side===2&&i.forceSinglePass===!1?(i.side=1,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=0,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=2):T.renderBufferDirect(n,t,r,i,e,a),e.onAfterRender(T,t,n,r,i,a)}function ct(e){let t=0;for(let n of e)n.texture!==null&&t++;return t}function lt(e,t,n){t.isScene!==!0&&(t=Se);let r=L.get(e),i=x.state.lights,a=x.state.shadowsArray,o=i.state.version,s=Me.getParameters(e,i.state,a,t,n,x.state.lightProbeGridArray),c=Me.getProgramCacheKey(s),l=r.programs;r.environment=e.isMeshStandardMaterial||e.isMeshLambertMaterial||e.isMeshPhongMaterial?t.environment:null,r.fog=t.fog;let u=e.isMeshStandardMaterial||e.isMeshLambertMaterial&&!e.envMap||e.isMeshPhongMaterial&&!e.envMap;r.envMap=Oe.get(e.envMap||r.environment,u),r.envMapRotation=r.environment!==null&&e.envMap===null?t.environmentRotation:e.envMapRotation,l===void 0&&(e.addEventListener(`dispose`,Xe),l=new Map,r.programs=l,r.programVariants=new Map);let d=l.get(c);if(d!==void 0){if(r.currentProgram===d&&r.lightsStateVersion===o)return ft(e,s),d}else s.uniforms=Me.getUniforms(e),D!==null&&e.isNodeMaterial&&D.build(e,n,s),e.onBeforeCompile(s,T),d=Me.acquireProgram(s,c),l.set(c,d),r.uniforms=s.uniforms;let f=r.uniforms;return(!e.isShaderMaterial&&!e.isRawShaderMaterial||e.clipping===!0)&&(f.clippingPlanes=Ie.uniform),ft(e,s),r.needsLights=ht(e),r.lightsStateVersion=o,r.needsLights&&(f.ambientLightColor.value=i.state.ambient,f.lightProbe.value=i.state.probe,f.sunLights.value=i.state.sun,f.sunLightShadows.value=i.state.sunShadow,f.directionalLights.value=i.state.directional,f.directionalLightShadows.value=i.state.directionalShadow,f.spotLights.value=i.state.spot,f.spotLightShadows.value=i.state.spotShadow,f.rectAreaLights.value=i.state.rectArea,f.ltc_1.value=i.state.rectAreaLTC1,f.ltc_2.value=i.state.rectAreaLTC2,f.pointLights.value=i.state.point,f.pointLightShadows.value=i.state.pointShadow,f.hemisphereLights.value=i.state.hemi,f.sunShadowMatrix.value=i.state.sunShadowMatrix,f.sunShadowCascade.value=i.state.sunShadowCascade,f.directionalShadowMatrix.value=i.state.directionalShadowMatrix,f.spotLightMatrix.value=i.state.spotLightMatrix,f.spotLightMap.value=i.state.spotLightMap,f.pointShadowMatrix.value=i.state.pointShadowMatrix),r.numLightProbeGrids=ct(x.state.lightProbeGridArray),r.currentProgram=d,r.uniformsList=null,d}function ut(e,t,n,r,i){let a=L.get(e),o=a.currentProgram.id+`,`+r+`,`+i,s=a.programVariants.get(o);return s===void 0?(s=lt(e,t,n),a.programVariants.set(o,s)):(a.currentProgram=s,a.uniformsList=null,a.outputColorSpace=r,a.toneMapping=i),s}function dt(e){if(e.uniformsList===null){let t=e.currentProgram.getUniforms();e.uniformsList=h_.seqWithValue(t.seq,e.uniforms)}return e.uniformsList}function ft(e,t){let n=L.get(e);n.outputColorSpace=t.outputColorSpace,n.batching=t.batching,n.batchingColor=t.batchingColor,n.instancing=t.instancing,n.instancingColor=t.instancingColor,n.instancingMorph=t.instancingMorph,n.skinning=t.skinning,n.morphTargets=t.morphTargets,n.morphNormals=t.morphNormals,n.morphColors=t.morphColors,n.morphTargetsCount=t.morphTargetsCount,n.numClippingPlanes=t.numClippingPlanes,n.numIntersection=t.numClipIntersection,n.vertexAlphas=t.vertexAlphas,n.vertexTangents=t.vertexTangents,n.toneMapping=t.toneMapping}function pt(e,t,n,r,i){t.isScene!==!0&&(t=Se),R.resetTextureUnits();let a=t.fog,o=r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial?t.environment:null,s=M===null?T.outputColorSpace:M.isXRRenderTarget===!0?M.texture.colorSpace:Ed.workingColorSpace,c=r.isMeshStandardMaterial||r.isMeshLambertMaterial&&!r.envMap||r.isMeshPhongMaterial&&!r.envMap,l=Oe.get(r.envMap||o,c),u=r.vertexColors===!0&&!!n.attributes.color&&n.attributes.color.itemSize===4,d=!!n.attributes.tangent&&(!!r.normalMap||r.anisotropy>0),f=!!n.morphAttributes.position,p=!!n.morphAttributes.normal,m=!!n.morphAttributes.color,h=0;r.toneMapped&&(M===null||M.isXRRenderTarget===!0)&&(h=T.toneMapping);let g=n.morphAttributes.position||n.morphAttributes.normal||n.morphAttributes.color,_=g===void 0?0:g.length,v=L.get(r),b=x.state.lights;if(_e===!0&&(ve===!0||e!==ne)){let t=e===ne&&r.id===te;Ie.setState(r,e,t)}let S=!1,C=!1;r.version===v.__version?v.needsLights&&v.lightsStateVersion!==b.state.version||i.isBatchedMesh&&v.batching===!1||!i.isBatchedMesh&&v.batching===!0||i.isBatchedMesh&&v.batchingColor===!0&&i._colorsTexture===null||i.isBatchedMesh&&v.batchingColor===!1&&i._colorsTexture!==null||i.isInstancedMesh&&v.instancing===!1||!i.isInstancedMesh&&v.instancing===!0||i.isSkinnedMesh&&v.skinning===!1||!i.isSkinnedMesh&&v.skinning===!0||i.isInstancedMesh&&v.instancingColor===!0&&i.instanceColor===null||i.isInstancedMesh&&v.instancingColor===!1&&i.instanceColor!==null||i.isInstancedMesh&&v.instancingMorph===!0&&i.morphTexture===null||i.isInstancedMesh&&v.instancingMorph===!1&&i.morphTexture!==null?S=!0:v.envMap===l?r.fog===!0&&v.fog!==a||v.numClippingPlanes!==void 0&&(v.numClippingPlanes!==Ie.numPlanes||v.numIntersection!==Ie.numIntersection)?S=!0:v.vertexAlphas===u&&v.vertexTangents===d&&v.morphTargets===f&&v.morphNormals===p&&v.morphColors===m&&v.morphTargetsCount===_&&v.numLightProbeGrids===ct(x.state.lightProbeGridArray)?(v.outputColorSpace!==s||v.toneMapping!==h)&&(C=!0):S=!0:S=!0:(S=!0,v.__version=r.version);let w=v.currentProgram;(S===!0||C===!0)&&(w=C===!0?ut(r,t,i,s,h):lt(r,t,i),D&&r.isNodeMaterial&&D.onUpdateProgram(r,w,v));let E=!1,O=!1,k=!1,A=w.getUniforms(),j=v.uniforms;if(F.useProgram(w.program)&&(E=!0,O=!0,k=!0),r.id!==te&&(te=r.id,O=!0),E||ne!==e){F.buffers.depth.getReversed()&&e.reversedDepth!==!0&&(e._reversedDepth=!0,e.updateProjectionMatrix()),A.setValue(P,`projectionMatrix`,e.projectionMatrix),A.setValue(P,`viewMatrix`,e.matrixWorldInverse);let t=A.map.cameraPosition;t!==void 0&&t.setValue(P,be.setFromMatrixPosition(e.matrixWorld)),De.logarithmicDepthBuffer&&A.setValue(P,`logDepthBufFC`,2/(Math.log(e.far+1)/Math.LN2)),(r.isMeshPhongMaterial||r.isMeshToonMaterial||r.isMeshLambertMaterial||r.isMeshBasicMaterial||r.isMeshStandardMaterial||r.isShaderMaterial)&&A.setValue(P,`isOrthographic`,e.isOrthographicCamera===!0),ne!==e&&(ne=e,O=!0,k=!0)}if(v.needsLights&&(b.state.sunShadowMap.length>0&&A.setValue(P,`sunShadowMap`,b.state.sunShadowMap,R),b.state.directionalShadowMap.length>0&&A.setValue(P,`directionalShadowMap`,b.state.directionalShadowMap,R),b.state.spotShadowMap.length>0&&A.setValue(P,`spotShadowMap`,b.state.spotShadowMap,R),b.state.pointShadowMap.length>0&&A.setValue(P,`pointShadowMap`,b.state.pointShadowMap,R)),i.isSkinnedMesh){A.setOptional(P,i,`bindMatrix`),A.setOptional(P,i,`bindMatrixInverse`);let e=i.skeleton;e&&(e.boneTexture===null&&e.computeBoneTexture(),A.setValue(P,`boneTexture`,e.boneTexture,R))}i.isBatchedMesh&&(A.setOptional(P,i,`batchingTexture`),A.setValue(P,`batchingTexture`,i._matricesTexture,R),A.setOptional(P,i,`batchingIdTexture`),A.setValue(P,`batchingIdTexture`,i._indirectTexture,R),A.setOptional(P,i,`batchingColorTexture`),i._colorsTexture!==null&&A.setValue(P,`batchingColorTexture`,i._colorsTexture,R));let ee=n.morphAttributes;if((ee.position!==void 0||ee.normal!==void 0||ee.color!==void 0)&&ze.update(i,n,w),(O||v.receiveShadow!==i.receiveShadow)&&(v.receiveShadow=i.receiveShadow,A.setValue(P,`receiveShadow`,i.receiveShadow)),(r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial)&&r.envMap===null&&t.environment!==null&&(j.envMapIntensity.value=t.environmentIntensity),j.dfgLUT!==void 0&&(j.dfgLUT.value=Mv()),O){if(A.setValue(P,`toneMappingExposure`,T.toneMappingExposure),v.needsLights&&mt(j,k),a&&r.fog===!0&&Ne.refreshFogUniforms(j,a),Ne.refreshMaterialUniforms(j,r,le,ce,x.state.transmissionRenderTarget[e.id]),v.needsLights&&v.numLightProbeGrids>0){let e=y,t=0;for(let n of x.state.lightProbeGridArray)n.texture!==null&&(e.textures[t]=n.texture,e.min[t]=n.boundingBox.min,e.max[t]=n.boundingBox.max,e.resolution[t]=n.resolution,t++);for(let n in e)e[n].length=t;j.probesSH.value=e.textures,j.probesMin.value=e.min,j.probesMax.value=e.max,j.probesResolution.value=e.resolution}h_.upload(P,dt(v),j,R)}if(r.isShaderMaterial&&r.uniformsNeedUpdate===!0&&(h_.upload(P,dt(v),j,R),r.uniformsNeedUpdate=!1),r.isSpriteMaterial&&A.setValue(P,`center`,i.center),A.setValue(P,`modelViewMatrix`,i.modelViewMatrix),A.setValue(P,`normalMatrix`,i.normalMatrix),A.setValue(P,`modelMatrix`,i.matrixWorld),r.uniformsGroups!==void 0){let e=r.uniformsGroups;for(let t=0,n=e.length;t<n;t++){let n=e[t];We.update(n,w),We.bind(n,w)}}return w}function mt(e,t){e.ambientLightColor.needsUpdate=t,e.lightProbe.needsUpdate=t,e.sunLights.needsUpdate=t,e.sunLightShadows.needsUpdate=t,e.directionalLights.needsUpdate=t,e.directionalLightShadows.needsUpdate=t,e.pointLights.needsUpdate=t,e.pointLightShadows.needsUpdate=t,e.spotLights.needsUpdate=t,e.spotLightShadows.needsUpdate=t,e.rectAreaLights.needsUpdate=t,e.hemisphereLights.needsUpdate=t}function ht(e){return e.isMeshLambertMaterial||e.isMeshToonMaterial||e.isMeshPhongMaterial||e.isMeshStandardMaterial||e.isShadowMaterial||e.isShaderMaterial&&e.lights===!0}this.getActiveCubeFace=function(){return j},this.getActiveMipmapLevel=function(){return ee},this.getRenderTarget=function(){return M},this.setRenderTargetTextures=function(e,t,n){let r=L.get(e);r.__autoAllocateDepthBuffer=e.resolveDepthBuffer===!1,r.__autoAllocateDepthBuffer===!1&&(r.__useRenderToTexture=!1),L.get(e.texture).__webglTexture=t,L.get(e.depthTexture).__webglTexture=r.__autoAllocateDepthBuffer?void 0:n,r.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(e,t){let n=L.get(e);n.__webglFramebuffer=t,n.__useDefaultFramebuffer=t===void 0},this.setRenderTarget=function(e,t=0,n=0){M=e,j=t,ee=n;let r=null,i=!1,a=!1;if(e){let o=L.get(e);if(o.__useDefaultFramebuffer!==void 0){F.bindFramebuffer(P.FRAMEBUFFER,o.__webglFramebuffer),N.copy(e.viewport),re.copy(e.scissor),ie=e.scissorTest,F.viewport(N),F.scissor(re),F.setScissorTest(ie),te=-1;return}if(o.__webglFramebuffer===void 0)R.setupRenderTarget(e);else if(o.__hasExternalTextures)R.rebindTextures(e,L.get(e.texture).__webglTexture,L.get(e.depthTexture).__webglTexture);else if(e.depthBuffer){let t=e.depthTexture;if(o.__boundDepthTexture!==t){if(t!==null&&L.has(t)&&(e.width!==t.image.width||e.height!==t.image.height))throw Error(`THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.`);R.setupDepthRenderbuffer(e)}}let s=e.texture;(s.isData3DTexture||s.isDataArrayTexture||s.isCompressedArrayTexture)&&(a=!0);let c=L.get(e).__webglFramebuffer;e.isWebGLCubeRenderTarget?(r=Array.isArray(c[t])?c[t][n]:c[t],i=!0):r=e.samples>0&&R.useMultisampledRTT(e)===!1?L.get(e).__webglMultisampledFramebuffer:Array.isArray(c)?c[n]:c,N.copy(e.viewport),re.copy(e.scissor),ie=e.scissorTest}else N.copy(fe).multiplyScalar(le).floor(),re.copy(pe).multiplyScalar(le).floor(),ie=me;if(n!==0&&(r=O),F.bindFramebuffer(P.FRAMEBUFFER,r)&&F.drawBuffers(e,r),F.viewport(N),F.scissor(re),F.setScissorTest(ie),i){let r=L.get(e.texture);P.framebufferTexture2D(P.FRAMEBUFFER,P.COLOR_ATTACHMENT0,P.TEXTURE_CUBE_MAP_POSITIVE_X+t,r.__webglTexture,n)}else if(a){let r=t;for(let t=0;t<e.textures.length;t++){let i=L.get(e.textures[t]);P.framebufferTextureLayer(P.FRAMEBUFFER,P.COLOR_ATTACHMENT0+t,i.__webglTexture,n,r)}}else if(e!==null&&n!==0){let t=L.get(e.texture);P.framebufferTexture2D(P.FRAMEBUFFER,P.COLOR_ATTACHMENT0,P.TEXTURE_2D,t.__webglTexture,n)}te=-1};function gt(e){let t=L.get(e);return(t.__readFormat!==e.format||t.__readType!==e.type)&&(t.__readFormat=e.format,t.__readType=e.type,t.__formatReadable=De.textureFormatReadable(e.format),t.__typeReadable=De.textureTypeReadable(e.type)),t}this.readRenderTargetPixels=function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget)){q(`WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);return}let c=L.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){F.bindFramebuffer(P.FRAMEBUFFER,c);try{let o=e.textures[s],c=o.format,l=o.type;e.textures.length>1&&P.readBuffer(P.COLOR_ATTACHMENT0+s);let u=gt(o);if(u.__formatReadable===!1){q(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.`);return}if(u.__typeReadable===!1){q(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.`);return}t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i&&P.readPixels(t,n,r,i,He.convert(c),He.convert(l),a)}finally{let e=M===null?null:L.get(M).__webglFramebuffer;F.bindFramebuffer(P.FRAMEBUFFER,e)}}},this.readRenderTargetPixelsAsync=async function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget))throw Error(`THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);let c=L.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){if(t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i){F.bindFramebuffer(P.FRAMEBUFFER,c);let o=e.textures[s],l=o.format,u=o.type;e.textures.length>1&&P.readBuffer(P.COLOR_ATTACHMENT0+s);let d=gt(o);if(d.__formatReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.`);if(d.__typeReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.`);let f=P.createBuffer();P.bindBuffer(P.PIXEL_PACK_BUFFER,f),P.bufferData(P.PIXEL_PACK_BUFFER,a.byteLength,P.STREAM_READ),P.readPixels(t,n,r,i,He.convert(l),He.convert(u),0),P.bindBuffer(P.PIXEL_PACK_BUFFER,null);let p=M===null?null:L.get(M).__webglFramebuffer;F.bindFramebuffer(P.FRAMEBUFFER,p);let m=P.fenceSync(P.SYNC_GPU_COMMANDS_COMPLETE,0);return P.flush(),await Uu(P,m,4),P.bindBuffer(P.PIXEL_PACK_BUFFER,f),P.getBufferSubData(P.PIXEL_PACK_BUFFER,0,a),P.bindBuffer(P.PIXEL_PACK_BUFFER,null),P.deleteBuffer(f),P.deleteSync(m),a}throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.`)}},this.copyFramebufferToTexture=function(e,t=null,n=0){let r=2**-n,i=Math.floor(e.image.width*r),a=Math.floor(e.image.height*r),o=t===null?0:t.x,s=t===null?0:t.y;R.setTexture2D(e,0),P.copyTexSubImage2D(P.TEXTURE_2D,n,0,0,o,s,i,a),F.unbindTexture()},this.copyTextureToTexture=function(e,t,n=null,r=null,i=0,a=0){let o,s,c,l,u,d,f,p,m,h=e.isCompressedTexture?e.mipmaps[a]:e.image;if(n!==null)o=n.max.x-n.min.x,s=n.max.y-n.min.y,c=n.isBox3?n.max.z-n.min.z:1,l=n.min.x,u=n.min.y,d=n.isBox3?n.min.z:0;else{let t=2**-i;o=Math.floor(h.width*t),s=Math.floor(h.height*t),c=e.isDataArrayTexture?h.depth:e.isData3DTexture?Math.floor(h.depth*t):1,l=0,u=0,d=0}r===null?(f=0,p=0,m=0):(f=r.x,p=r.y,m=r.z);let g=He.convert(t.format),_=He.convert(t.type),v;t.isData3DTexture?(R.setTexture3D(t,0),v=P.TEXTURE_3D):t.isDataArrayTexture||t.isCompressedArrayTexture?(R.setTexture2DArray(t,0),v=P.TEXTURE_2D_ARRAY):(R.setTexture2D(t,0),v=P.TEXTURE_2D),F.activeTexture(P.TEXTURE0),F.pixelStorei(P.UNPACK_FLIP_Y_WEBGL,t.flipY),F.pixelStorei(P.UNPACK_PREMULTIPLY_ALPHA_WEBGL,t.premultiplyAlpha),F.pixelStorei(P.UNPACK_ALIGNMENT,t.unpackAlignment);let y=F.getParameter(P.UNPACK_ROW_LENGTH),b=F.getParameter(P.UNPACK_IMAGE_HEIGHT),x=F.getParameter(P.UNPACK_SKIP_PIXELS),S=F.getParameter(P.UNPACK_SKIP_ROWS),C=F.getParameter(P.UNPACK_SKIP_IMAGES);F.pixelStorei(P.UNPACK_ROW_LENGTH,h.width),F.pixelStorei(P.UNPACK_IMAGE_HEIGHT,h.height),F.pixelStorei(P.UNPACK_SKIP_PIXELS,l),F.pixelStorei(P.UNPACK_SKIP_ROWS,u),F.pixelStorei(P.UNPACK_SKIP_IMAGES,d);let w=e.isDataArrayTexture||e.isData3DTexture,T=t.isDataArrayTexture||t.isData3DTexture;if(e.isDepthTexture){let n=L.get(e),r=L.get(t),h=L.get(n.__renderTarget),g=L.get(r.__renderTarget);F.bindFramebuffer(P.READ_FRAMEBUFFER,h.__webglFramebuffer),F.bindFramebuffer(P.DRAW_FRAMEBUFFER,g.__webglFramebuffer);for(let n=0;n<c;n++)w&&(P.framebufferTextureLayer(P.READ_FRAMEBUFFER,P.COLOR_ATTACHMENT0,L.get(e).__webglTexture,i,d+n),P.framebufferTextureLayer(P.DRAW_FRAMEBUFFER,P.COLOR_ATTACHMENT0,L.get(t).__webglTexture,a,m+n)),P.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,P.DEPTH_BUFFER_BIT,P.NEAREST);F.bindFramebuffer(P.READ_FRAMEBUFFER,null),F.bindFramebuffer(P.DRAW_FRAMEBUFFER,null)}else if(i!==0||e.isRenderTargetTexture||L.has(e)){let n=L.get(e),r=L.get(t);F.bindFramebuffer(P.READ_FRAMEBUFFER,k),F.bindFramebuffer(P.DRAW_FRAMEBUFFER,A);for(let e=0;e<c;e++)w?P.framebufferTextureLayer(P.READ_FRAMEBUFFER,P.COLOR_ATTACHMENT0,n.__webglTexture,i,d+e):P.framebufferTexture2D(P.READ_FRAMEBUFFER,P.COLOR_ATTACHMENT0,P.TEXTURE_2D,n.__webglTexture,i),T?P.framebufferTextureLayer(P.DRAW_FRAMEBUFFER,P.COLOR_ATTACHMENT0,r.__webglTexture,a,m+e):P.framebufferTexture2D(P.DRAW_FRAMEBUFFER,P.COLOR_ATTACHMENT0,P.TEXTURE_2D,r.__webglTexture,a),i===0?T?P.copyTexSubImage3D(v,a,f,p,m+e,l,u,o,s):P.copyTexSubImage2D(v,a,f,p,l,u,o,s):P.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,P.COLOR_BUFFER_BIT,P.NEAREST);F.bindFramebuffer(P.READ_FRAMEBUFFER,null),F.bindFramebuffer(P.DRAW_FRAMEBUFFER,null)}else T?e.isDataTexture||e.isData3DTexture?P.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h.data):t.isCompressedArrayTexture?P.compressedTexSubImage3D(v,a,f,p,m,o,s,c,g,h.data):P.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h):e.isDataTexture?P.texSubImage2D(P.TEXTURE_2D,a,f,p,o,s,g,_,h.data):e.isCompressedTexture?P.compressedTexSubImage2D(P.TEXTURE_2D,a,f,p,h.width,h.height,g,h.data):P.texSubImage2D(P.TEXTURE_2D,a,f,p,o,s,g,_,h);F.pixelStorei(P.UNPACK_ROW_LENGTH,y),F.pixelStorei(P.UNPACK_IMAGE_HEIGHT,b),F.pixelStorei(P.UNPACK_SKIP_PIXELS,x),F.pixelStorei(P.UNPACK_SKIP_ROWS,S),F.pixelStorei(P.UNPACK_SKIP_IMAGES,C),a===0&&t.generateMipmaps===!0&&t.mipmapsAutoUpdate===!0&&P.generateMipmap(v),F.unbindTexture()},this.initRenderTarget=function(e){L.get(e).__webglFramebuffer===void 0&&R.setupRenderTarget(e)},this.initTexture=function(e){e.isCubeTexture?R.setTextureCube(e,0):e.isData3DTexture?R.setTexture3D(e,0):e.isDataArrayTexture||e.isCompressedArrayTexture?R.setTexture2DArray(e,0):R.setTexture2D(e,0),F.unbindTexture()},this.resetState=function(){j=0,ee=0,M=null,F.reset(),Ue.reset()},typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}get coordinateSystem(){return Pu}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=Ed._getDrawingBufferColorSpace(e),t.unpackColorSpace=Ed._getUnpackColorSpace()}},Pv={slot:[0,0],from:[0,0],turn:0,isFixed:!1};function Fv(e,t){let n=[...kt(e,({file:e},t)=>e||t).values()],r=new Map,i=n.map(Lv),a=i.map(([,,e])=>.95*t+e),o=-a.reduce((e,t)=>e+t,0)/2;return n.forEach((e,t)=>{let[s,c]=i[t],l={...Pv,slot:[o+a[t]/2,0],from:[s,c]};o+=a[t];for(let t of e)r.set(t,n.length===1?Pv:{...l,isFixed:e.length===1})}),e.map(e=>({motion:e.motion,name:e.name,placement:r.get(e),segment:null}))}function Iv({placement:e}){return e===Pv}function Lv(e){if(e.length<2)return[0,0,0];let t=e.map(({motion:e})=>fi(e,0)),[n,r]=[t.map(([e])=>e),t.map(([,e])=>e)],[i,a]=[Math.min(...n),Math.max(...n)];return[(i+a)/2,(Math.min(...r)+Math.max(...r))/2,a-i]}function Rv(e,t,n){let r=t.slice(0,24),i=Math.ceil(Math.sqrt(r.length*1.7)),a=Math.ceil(r.length/i);return r.map((t,o)=>{let s=Math.floor(o/i),c=s===a-1?r.length-s*i:i;return{motion:e,name:``,placement:{slot:[(o%i-(c-1)/2)*.85*n,((a-1)/2-s)*1.05*n],from:fi(e,t.start_s),turn:-pi(e,t.start_s),isFixed:!1},segment:t}})}function zv(e,t,n){let{segment:r}=e;if(!r)return t;let i=n?(t-n.start_s)/(n.stop_s-n.start_s):0,a=Math.min(Math.max(i,0),1);return r.start_s+a*(r.stop_s-r.start_s)}function Bv(e,t,n){if(t===Pv)return;let r=Math.cos(t.turn),i=Math.sin(t.turn),a=t.isFixed?e[3*n]||0:t.from[0],o=t.isFixed?e[3*n+2]||0:t.from[1];for(let n=0;n<e.length;n+=3){let s=e[n]-a,c=e[n+2]-o;e[n]=t.slot[0]+s*r+c*i,e[n+2]=t.slot[1]-s*i+c*r}}var Vv=.62;function Hv(e){let{head:t}=e,n=di(e),r=[],i=[],a=t.bones.map(()=>[]),o=t.n_samples/t.sample_fps;for(let s=0;s<100;s++){ui(e,o*s/100,n);let c=[0,1,2].map(e=>n.filter((t,n)=>n%3===e&&!Number.isNaN(t)));c[0].length&&(r.push(Math.min(...c[1])),i.push(Math.max(...c.map(e=>Math.max(...e)-Math.min(...e)))),t.bones.forEach(([e,t],r)=>{let i=[0,1,2].map(r=>n[3*e+r]-n[3*t+r]),o=Math.hypot(...i);Number.isFinite(o)&&a[r].push(o)}))}let s=Kv(i,.5)||1,c=Uv(t,s,a.map(e=>Kv(e,.5))),l=Wv(t,s,c),u=t.bones.findIndex(([,e])=>e===t.effectors.head);return{size:s,ground:Kv(r,.05)-.008*s,bones:c,joints:l,skull:u}}function Uv(e,t,n){let r=Gv(e,e.effectors.head??-1);return Float32Array.from(n,(n,i)=>{let[a,o]=e.bones[i],s=.03*Math.sqrt(n/(.23*t)),c=r.has(a)&&r.has(o)?1.5:1;return t*Math.min(Math.max(s*c,.005),.036)})}function Wv(e,t,n){let r=new Float32Array(e.joints.length);e.bones.forEach(([e,t],i)=>{r[e]=Math.max(r[e],1.12*n[i]),r[t]=Math.max(r[t],1.2*Vv*n[i])});let i=e.effectors.head??-1;return r.map((e,n)=>n===i&&e>0?0:e||.011*t)}function Gv(e,t){let n=new Set;for(let r=t;r>=0&&!n.has(r);r=e.parents[r]??-1)n.add(r);return n}function Kv(e,t){let n=[...e].sort((e,t)=>e-t);return n[Math.min(Math.floor(t*n.length),n.length-1)]??0}var qv=At(Hv);async function Jv({motion:e,numbers:t,...n}){return{motion:await si(e,hi(t).buffer),step:n}}function Yv({motion:{head:e}}){return Math.max(e.n_samples-1,1)/e.sample_fps}function Xv(e,t,n){let r=Yv(e),i=Math.floor(t/r);ui(e.motion,t-i*r,n),Bv(n,Zv(e,i),0)}function Zv({step:e},t){let[n,r]=[Math.cos(e.turn),Math.sin(e.turn)],[i,a]=[0,0];for(let o=0;o<t;o++)[i,a]=[i*n+a*r+e.x,a*n-i*r+e.z];return{slot:[i,a],from:[0,0],turn:t*e.turn,isFixed:!1}}var Qv={type:`change`},$v={type:`start`},ey={type:`end`},ty=new jp,ny=new wp,ry=Math.cos(70*vd.DEG2RAD),iy=new X,ay=2*Math.PI,oy={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},sy=1e-6,cy=class extends xh{constructor(e,t=null){super(e,t),this.state=oy.NONE,this.target=new X,this.cursor=new X,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:`ArrowLeft`,UP:`ArrowUp`,RIGHT:`ArrowRight`,BOTTOM:`ArrowDown`},this.mouseButtons={LEFT:rl.ROTATE,MIDDLE:rl.DOLLY,RIGHT:rl.PAN},this.touches={ONE:il.ROTATE,TWO:il.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle=`auto`,this._domElementKeyEvents=null,this._lastPosition=new X,this._lastQuaternion=new yd,this._lastTargetPosition=new X,this._quat=new yd().setFromUnitVectors(e.up,new X(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new bh,this._sphericalDelta=new bh,this._scale=1,this._panOffset=new X,this._rotateStart=new Y,this._rotateEnd=new Y,this._rotateDelta=new Y,this._panStart=new Y,this._panEnd=new Y,this._panDelta=new Y,this._dollyStart=new Y,this._dollyEnd=new Y,this._dollyDelta=new Y,this._dollyDirection=new X,this._mouse=new Y,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=uy.bind(this),this._onPointerDown=ly.bind(this),this._onPointerUp=dy.bind(this),this._onContextMenu=vy.bind(this),this._onMouseWheel=my.bind(this),this._onKeyDown=hy.bind(this),this._onTouchStart=gy.bind(this),this._onTouchMove=_y.bind(this),this._onMouseDown=fy.bind(this),this._onMouseMove=py.bind(this),this._interceptControlDown=yy.bind(this),this._interceptControlUp=by.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e===`grab`?this.domElement.style.cursor=`grab`:this.domElement.style.cursor=`auto`}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener(`pointerdown`,this._onPointerDown),this.domElement.addEventListener(`pointercancel`,this._onPointerUp),this.domElement.addEventListener(`contextmenu`,this._onContextMenu),this.domElement.addEventListener(`wheel`,this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener(`keydown`,this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction=`none`}disconnect(){this.state=oy.NONE,this.domElement.removeEventListener(`pointerdown`,this._onPointerDown),this.domElement.ownerDocument.removeEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.removeEventListener(`pointerup`,this._onPointerUp),this.domElement.removeEventListener(`pointercancel`,this._onPointerUp),this.domElement.removeEventListener(`wheel`,this._onMouseWheel),this.domElement.removeEventListener(`contextmenu`,this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener(`keydown`,this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener(`keyup`,this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction=``,this.domElement.style.cursor=`auto`}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener(`keydown`,this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener(`keydown`,this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Qv),this.update(),this.state=oy.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;iy.copy(t).sub(this.target),iy.applyQuaternion(this._quat),this._spherical.setFromVector3(iy),this.autoRotate&&this.state===oy.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,r=this.maxAzimuthAngle;isFinite(n)&&isFinite(r)&&(n<-Math.PI?n+=ay:n>Math.PI&&(n-=ay),r<-Math.PI?r+=ay:r>Math.PI&&(r-=ay),n<=r?this._spherical.theta=Math.max(n,Math.min(r,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+r)/2?Math.max(n,this._spherical.theta):Math.min(r,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let i=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let e=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),i=e!=this._spherical.radius}if(iy.setFromSpherical(this._spherical),iy.applyQuaternion(this._quatInverse),t.copy(this.target).add(iy),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let e=null;if(this.object.isPerspectiveCamera){let t=iy.length();e=this._clampDistance(t*this._scale);let n=t-e;this.object.position.addScaledVector(this._dollyDirection,n),this.object.updateMatrixWorld(),i=!!n}else if(this.object.isOrthographicCamera){let t=new X(this._mouse.x,this._mouse.y,0);t.unproject(this.object);let n=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),i=n!==this.object.zoom;let r=new X(this._mouse.x,this._mouse.y,0);r.unproject(this.object),this.object.position.sub(r).add(t),this.object.updateMatrixWorld(),e=iy.length()}else console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled.`),this.zoomToCursor=!1;e!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(e).add(this.object.position):(ty.origin.copy(this.object.position),ty.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(ty.direction))<ry?this.object.lookAt(this.target):(ny.setFromNormalAndCoplanarPoint(this.object.up,this.target),ty.intersectPlane(ny,this.target))))}else if(this.object.isOrthographicCamera){let e=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),e!==this.object.zoom&&(this.object.updateProjectionMatrix(),i=!0)}return this._scale=1,this._performCursorZoom=!1,i||this._lastPosition.distanceToSquared(this.object.position)>sy||8*(1-this._lastQuaternion.dot(this.object.quaternion))>sy||this._lastTargetPosition.distanceToSquared(this.target)>sy?(this.dispatchEvent(Qv),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e===null?ay/60/60*this.autoRotateSpeed:ay/60*this.autoRotateSpeed*e}_getZoomScale(e){let t=Math.abs(e*.01);return .95**(this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){iy.setFromMatrixColumn(t,0),iy.multiplyScalar(-e),this._panOffset.add(iy)}_panUp(e,t){this.screenSpacePanning===!0?iy.setFromMatrixColumn(t,1):(iy.setFromMatrixColumn(t,0),iy.crossVectors(this.object.up,iy)),iy.multiplyScalar(e),this._panOffset.add(iy)}_pan(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let r=this.object.position;iy.copy(r).sub(this.target);let i=iy.length();i*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*i/n.clientHeight,this.object.matrix),this._panUp(2*t*i/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - pan disabled.`),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled.`),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled.`),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),r=e-n.left,i=t-n.top,a=n.width,o=n.height;this._mouse.x=r/a*2-1,this._mouse.y=-(i/o)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ay*this._rotateDelta.x/t.clientHeight),this._rotateUp(ay*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(ay*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-ay*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(ay*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-ay*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._rotateStart.set(n,r)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._panStart.set(n,r)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,r=e.pageY-t.y,i=Math.sqrt(n*n+r*r);this._dollyStart.set(0,i)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._rotateEnd.set(n,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(ay*this._rotateDelta.x/t.clientHeight),this._rotateUp(ay*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._panEnd.set(n,r)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,r=e.pageY-t.y,i=Math.sqrt(n*n+r*r);this._dollyEnd.set(0,i),this._dollyDelta.set(0,(this._dollyEnd.y/this._dollyStart.y)**+this.zoomSpeed),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let a=(e.pageX+t.x)*.5,o=(e.pageY+t.y)*.5;this._updateZoomParameters(a,o)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new Y,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function ly(e){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(e.pointerId),this.domElement.ownerDocument.addEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.addEventListener(`pointerup`,this._onPointerUp)),this._isTrackingPointer(e)||(this._addPointer(e),e.pointerType===`touch`?this._onTouchStart(e):this._onMouseDown(e),this._cursorStyle===`grab`&&(this.domElement.style.cursor=`grabbing`)))}function uy(e){this.enabled!==!1&&(e.pointerType===`touch`?this._onTouchMove(e):this._onMouseMove(e))}function dy(e){switch(this._removePointer(e),this._pointers.length){case 0:this.domElement.releasePointerCapture(e.pointerId),this.domElement.ownerDocument.removeEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.removeEventListener(`pointerup`,this._onPointerUp),this.dispatchEvent(ey),this.state=oy.NONE,this._cursorStyle===`grab`&&(this.domElement.style.cursor=`grab`);break;case 1:let t=this._pointers[0],n=this._pointerPositions[t];this._onTouchStart({pointerId:t,pageX:n.x,pageY:n.y})}}function fy(e){let t;switch(e.button){case 0:t=this.mouseButtons.LEFT;break;case 1:t=this.mouseButtons.MIDDLE;break;case 2:t=this.mouseButtons.RIGHT;break;default:t=-1}switch(t){case rl.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(e),this.state=oy.DOLLY;break;case rl.ROTATE:if(e.ctrlKey||e.metaKey||e.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(e),this.state=oy.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(e),this.state=oy.ROTATE}break;case rl.PAN:if(e.ctrlKey||e.metaKey||e.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(e),this.state=oy.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(e),this.state=oy.PAN}break;default:this.state=oy.NONE}this.state!==oy.NONE&&this.dispatchEvent($v)}function py(e){switch(this.state){case oy.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(e);break;case oy.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(e);break;case oy.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(e)}}function my(e){this.enabled!==!1&&this.enableZoom!==!1&&this.state===oy.NONE&&(e.preventDefault(),this.dispatchEvent($v),this._handleMouseWheel(this._customWheelEvent(e)),this.dispatchEvent(ey))}function hy(e){this.enabled!==!1&&this._handleKeyDown(e)}function gy(e){switch(this._trackPointer(e),this._pointers.length){case 1:switch(this.touches.ONE){case il.ROTATE:if(this.enableRotate===!1){this.state=oy.NONE;break}this._handleTouchStartRotate(e),this.state=oy.TOUCH_ROTATE;break;case il.PAN:if(this.enablePan===!1){this.state=oy.NONE;break}this._handleTouchStartPan(e),this.state=oy.TOUCH_PAN;break;default:this.state=oy.NONE}break;case 2:switch(this.touches.TWO){case il.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(e),this.state=oy.TOUCH_DOLLY_PAN;break;case il.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(e),this.state=oy.TOUCH_DOLLY_ROTATE;break;default:this.state=oy.NONE}break;default:this.state=oy.NONE}this.state!==oy.NONE&&this.dispatchEvent($v)}function _y(e){switch(this._trackPointer(e),this.state){case oy.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(e),this.update();break;case oy.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(e),this.update();break;case oy.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(e),this.update();break;case oy.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(e),this.update();break;default:this.state=oy.NONE}}function vy(e){this.enabled!==!1&&e.preventDefault()}function yy(e){e.key===`Control`&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener(`keyup`,this._interceptControlUp,{passive:!0,capture:!0}))}function by(e){e.key===`Control`&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener(`keyup`,this._interceptControlUp,{passive:!0,capture:!0}))}var xy=32,Sy=class{scene=new Ef;camera=new nh(xy,1,.01,1e3);controls;sharpness;renderer;floor=new Ty;warmUpMesh;constructor(e){let{context:t,software:n}=Cy(e);this.sharpness=new Ay(n),this.renderer=new Nv({canvas:e,context:t}),this.renderer.debug.checkShaderErrors=!1,this.controls=new cy(this.camera,e),this.controls.enableDamping=!1,this.controls.maxPolarAngle=Math.PI/2-.02,this.scene.add(this.floor.mesh),this.warmUpMesh=new nm(new bp,Ry(this.fog,1),1);for(let e of[this.floor.mesh,this.warmUpMesh])this.renderer.compile(e,this.camera)}get fog(){return this.floor.fog}fit(e,t){this.floor.fit(e,t),this.controls.minDistance=.5*e,this.controls.maxDistance=14*e,this.camera.near=.05*e,this.camera.far=120*e,this.camera.updateProjectionMatrix()}setColors(){this.scene.background=new wf(W(`sky`)),this.floor.setColors()}lookAt(e,t,n,r,i=.22){let a=Math.tan(xy*Math.PI/360),o=Math.max(r/2/a,n/2/(a*this.camera.aspect))*1.12;this.controls.target.copy(e),this.camera.position.set(e.x+o*Math.sin(t),e.y+o*i,e.z+o*Math.cos(t)),this.controls.update()}moveTo(e,t){let n=e-this.controls.target.x,r=t-this.controls.target.z;this.controls.target.x+=n,this.controls.target.z+=r,this.camera.position.x+=n,this.camera.position.z+=r,this.controls.update()}orbit(e,t){let{target:n,minPolarAngle:r,maxPolarAngle:i}=this.controls,a=new bh().setFromVector3(this.camera.position.clone().sub(n));a.theta+=e;let o=r+.01;a.phi=Math.min(Math.max(a.phi+t,o),i),this.camera.position.setFromSpherical(a).add(n),this.controls.update()}resize(e,t){this.renderer.setSize(e,t,!1),this.camera.aspect=e/Math.max(t,1),this.camera.updateProjectionMatrix()}draw(e,t){e&&this.sharpness.recordDuration(t);let n=this.sharpness.getRatio(devicePixelRatio,e);n!==this.renderer.getPixelRatio()&&this.renderer.setPixelRatio(n);let{target:r}=this.controls;this.floor.centerOn(r,this.camera.position.distanceTo(r)),this.renderer.render(this.scene,this.camera)}dispose(){this.controls.dispose(),this.floor.dispose(),this.warmUpMesh.material.dispose(),this.renderer.dispose()}};function Cy(e){[e.width,e.height]=[e.clientWidth,e.clientHeight];let t=e.getContext(`webgl2`,{alpha:!1,antialias:!1,powerPreference:`low-power`});if(!t)throw Error(`This browser draws no pictures in 3-D (it has no WebGL 2).`);let n=t.getExtension(`WEBGL_debug_renderer_info`),r=n?String(t.getParameter(n.UNMASKED_RENDERER_WEBGL)):``;return{context:t,software:/swiftshader|llvmpipe|software|basic render/i.test(r)}}var wy=40,Ty=class{fog={sky:{value:new wf},fade:{value:new Y}};mesh;uniforms={...this.fog,ground:{value:new wf},grid:{value:new wf},cell:{value:1}};constructor(){let e=new hm(1,1).rotateX(-Math.PI/2),t=By(Iy,Ly,this.uniforms);t.setValues({depthTest:!1,depthWrite:!1}),this.mesh=new Wp(e,t),this.mesh.renderOrder=-1,this.mesh.frustumCulled=!1}setColors(){for(let e of[`ground`,`grid`,`sky`])this.uniforms[e].value.set(W(e))}fit(e,t){this.uniforms.cell.value=10**Math.round(Math.log10(e/1.7)),this.mesh.scale.setScalar(80*this.uniforms.cell.value),this.mesh.position.y=t}centerOn(e,t){this.mesh.position.x=e.x,this.mesh.position.z=e.z;let n=Math.min(t*6,t+.8*wy*this.uniforms.cell.value);this.uniforms.fade.value.set(t*1.1,n)}dispose(){this.mesh.geometry.dispose(),this.mesh.material.dispose()}},Ey=36,Dy=.5,Oy=2,ky=24,Ay=class{software;share=1;slow=0;drawn=0;constructor(e){this.software=e}getRatio(e,t){return t?this.share*(this.software?Math.min(e,1):Oy):this.software?Math.max(e,1.5):Oy}recordDuration(e){if(this.drawn+=1,e>1/Ey&&(this.slow+=1),this.drawn<ky)return;let t=this.slow/this.drawn>.5;this.drawn=this.slow=0,t&&(this.share=Math.max(this.share*.8,Dy))}},jy=`
precision highp float;
uniform vec3 sky;
uniform vec2 fade;
out vec4 pixel;
vec4 onScreen(vec3 light, float alpha) {
  vec3 bright = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  return vec4(mix(bright, 12.92 * light, vec3(lessThanEqual(light, vec3(0.0031308)))), alpha);
}
`,My=`
precision highp float;
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
`,Ny=`${My}
in mat4 instanceMatrix;
in vec3 normal;
uniform vec3 color;
uniform float lit;
uniform float alpha;
out vec4 paint;
out float far;
const vec3 SUN = normalize(vec3(2.0, 5.0, 3.0));
const vec3 GROUND = vec3(0.254, 0.275, 0.318);
void main() {
  mat3 turn = mat3(instanceMatrix);
  vec3 size = vec3(dot(turn[0], turn[0]), dot(turn[1], turn[1]), dot(turn[2], turn[2]));
  vec3 up = normalize(turn * (normal / max(size, 1e-12)) + vec3(0.0, 1e-9, 0.0));
  vec3 light = 0.67 * mix(GROUND, vec3(1.0), 0.5 + 0.5 * up.y) + 0.54 * max(dot(up, SUN), 0.0);
  paint = vec4(color * mix(vec3(1.0), light, lit), alpha);
  vec4 place = viewMatrix * modelMatrix * instanceMatrix * vec4(position, 1.0);
  far = -place.z;
  gl_Position = projectionMatrix * place;
}`,Py=`${My}
in vec4 color;
out vec4 paint;
out float far;
void main() {
  vec4 place = viewMatrix * modelMatrix * vec4(position, 1.0);
  paint = color;
  far = -place.z;
  gl_Position = projectionMatrix * place;
}`,Fy=`${jy}
in vec4 paint;
in float far;
void main() {
  pixel = onScreen(mix(paint.rgb, sky, smoothstep(fade.x, fade.y, far)), paint.a);
}`,Iy=`${My}
out vec3 place;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  place = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`,Ly=`${jy}
uniform vec3 cameraPosition;
uniform vec3 ground;
uniform vec3 grid;
uniform float cell;
in vec3 place;
void main() {
  vec2 at = place.xz / cell;
  vec2 wide = fwidth(at);
  vec2 away = abs(fract(at - 0.5) - 0.5);
  vec2 line = (1.0 - smoothstep(0.5 * wide, 1.5 * wide, away)) * (1.0 - min(2.0 * wide, 1.0));
  float far = smoothstep(fade.x, fade.y, distance(place, cameraPosition));
  pixel = onScreen(mix(mix(ground, grid, max(line.x, line.y)), sky, far), 1.0);
}`;function Ry(e,t){let n={color:{value:new wf},lit:{value:t},alpha:{value:1}};return By(Ny,Fy,{...e,...n})}function zy(e){let t=By(Py,Fy,{...e});return t.setValues({transparent:!0,depthWrite:!1,side:2}),t}function By(e,t,n){return new Em({glslVersion:Nu,vertexShader:e,fragmentShader:t,uniforms:n})}var Vy=new X(0,1,0),Hy=new X(.35,1,.25),Uy=.4,Wy=new mm(Vv,1,1,10,1,!0).translate(0,.5,0),Gy=new gm(1,14,10),Ky=class{head;anatomy;group=new _f;bones;joints;skull;meshes;materials;constructor(e,t,n){this.head=t,this.anatomy=n,this.materials={body:Ry(e,1),joint:Ry(e,1),shadow:Ry(e,0)};let{body:r,joint:i}=this.materials;this.bones=$y(Wy,r,t.bones.length),this.joints=$y(Gy,i,t.joints.length),this.skull=$y(Gy,r,1),this.meshes=[this.bones,this.joints,this.skull];let a=new _f;a.matrixAutoUpdate=!1,a.matrix.copy(nb(n.ground+.001*n.size)),a.add(...this.meshes.map(e=>this.createShadow(e))),this.group.add(...this.meshes,a)}setPose(e){let{bones:t,joints:n,skull:r}=this.anatomy;this.head.bones.forEach(([n,i],a)=>{let o=a===r?.6*t[a]:t[a],s=[eb(e,n,qy),eb(e,i,Jy)];this.bones.setMatrixAt(a,tb(...s,o))});for(let[t,r]of n.entries()){let n=Number.isNaN(eb(e,t,qy).x);Qy.makeScale(r,r,r).setPosition(qy),this.joints.setMatrixAt(t,n?Qy.makeScale(0,0,0):Qy)}this.skull.setMatrixAt(0,this.placeSkull(e));for(let e of this.meshes)e.instanceMatrix.needsUpdate=!0}setColors(e){for(let t of[`body`,`joint`,`shadow`])this.materials[t].uniforms.color.value.set(e[t])}setOpacity(e){for(let t of[this.materials.body,this.materials.joint])t.uniforms.alpha.value=e,t.transparent=!0;this.materials.shadow.visible=!1}dispose(){for(let e of this.meshes)e.dispose();for(let e of Object.values(this.materials))e.dispose()}placeSkull(e){let t=this.head.bones[this.anatomy.skull];if(!t)return Qy.makeScale(0,0,0);eb(e,t[0],qy),eb(e,t[1],Jy);let n=Yy.subVectors(Jy,qy).length();if(!(n>0))return Qy.makeScale(0,0,0);let r=Math.min(Uy*n,.07*this.anatomy.size);return Zy.setFromUnitVectors(Vy,Yy.divideScalar(n)),Qy.compose(qy.lerp(Jy,.55),Zy,Xy.set(r,.55*n,r*1.1))}createShadow(e){let t=$y(e.geometry,this.materials.shadow,e.count);return t.instanceMatrix=e.instanceMatrix,t}},qy=new X,Jy=new X,Yy=new X,Xy=new X,Zy=new yd,Qy=new Hd;function $y(e,t,n){let r=new nm(e,t,n);return r.frustumCulled=!1,r}function eb(e,t,n){return n.fromArray(e,3*t)}function tb(e,t,n){let r=Yy.subVectors(t,e).length();return r>0?(Zy.setFromUnitVectors(Vy,Yy.divideScalar(r)),Qy.compose(e,Zy,Xy.set(n,r,n))):Qy.makeScale(0,0,0)}function nb(e){let t=Hy.x/Hy.y,n=Hy.z/Hy.y;return new Hd(1,-t,0,t*e,0,0,0,e,0,-n,1,n*e,0,0,0,1)}var rb=.5,ib=class{scene;haze;figure=null;motion=null;pose=new Float32Array;constructor(e,t){this.scene=e,this.haze=t}show(e,t,n,r){if(!t||!n||n.start_frame===t.start_frame){this.figure&&(this.figure.group.visible=!1);return}let i=this.getFigure(e),a=ab(e,t,n);ui(e,zv({motion:e,name:``,placement:a,segment:t},r,n),this.pose),Bv(this.pose,a,mi(e.head)),i.setPose(this.pose);let o=W(`accent`);i.setColors({body:o,joint:o,shadow:o}),i.group.visible=!0}clear(){this.figure?.group.removeFromParent(),this.figure?.dispose(),this.figure=this.motion=null}getFigure(e){if(this.figure&&this.motion===e)return this.figure;this.clear();let t=new Ky(this.haze,e.head,qv(e));return t.setOpacity(rb),this.scene.add(t.group),this.pose=di(e),[this.figure,this.motion]=[t,e],t}};function ab(e,t,n){let[r,i]=[n,t].map(t=>fi(e,t.start_s));return{slot:r,from:i,turn:pi(e,n.start_s)-pi(e,t.start_s),isFixed:!1}}var ob=32,sb=class{n_trails;width;mesh;positions;colors;constructor(e,t,n){this.n_trails=t,this.width=n;let r=t*ob*2;this.positions=new ap(new Float32Array(r*3),3),this.colors=new ap(new Float32Array(r*4),4);let i=new bp;i.setAttribute(`position`,this.positions),i.setAttribute(`color`,this.colors),i.setIndex(pb(t)),this.mesh=new Wp(i,zy(e)),this.mesh.frustumCulled=!1}static listTimes(e,t){return Array.from({length:ob},(n,r)=>e-t*(1-r/31))}draw(e,t,n){for(let r=0;r<this.n_trails;r++){let i=e[r];for(let e=0;e<ob;e++){let a=this.computeSide(i,e,n),o=2*(r*ob+e);cb.fromArray(i,3*e);let s=Number.isNaN(cb.x);s&&cb.set(0,0,0);let c=s?0:.85*(e/31)**1.5,{r:l,g:u,b:d}=t[r][e];for(let[e,t]of[-1,1].entries()){let{x:n,y:r,z:i}=cb;this.positions.setXYZ(o+e,n+t*a.x,r+t*a.y,i+t*a.z),this.colors.setXYZW(o+e,l,u,d,c)}}}this.positions.needsUpdate=!0,this.colors.needsUpdate=!0}dispose(){this.mesh.geometry.dispose(),this.mesh.material.dispose()}computeSide(e,t,n){let r=Math.max(t-1,0),i=Math.min(t+1,31);lb.fromArray(e,3*i).sub(ub.fromArray(e,3*r)),db.fromArray(e,3*t).sub(n),fb.crossVectors(lb,db);let a=fb.length(),o=this.width/2*(.3+.7*t/ob);return a>1e-9?fb.multiplyScalar(o/a):fb.set(0,0,0)}},cb=new X,lb=new X,ub=new X,db=new X,fb=new X;function pb(e){let t=[];for(let n=0;n<e;n++)for(let e=0;e<31;e++){let r=2*(n*ob+e);t.push(r,r+1,r+2,r+1,r+3,r+2)}return t}var mb=1.2,hb=class{store;stage;placed=[];figures=[];trails=null;poses=[];contentKey=``;size=1;ghost;constructor(e,t){this.store=e,this.stage=new Sy(t),this.ghost=new ib(this.stage.scene,this.stage.fog)}populate(){this.clear(),this.placed=this.placeFigures(),this.figures=this.placed.map(({motion:e})=>new Ky(this.stage.fog,e.head,qv(e))),this.poses=this.placed.map(({motion:e})=>di(e));for(let e of this.figures)this.stage.scene.add(e.group);let e=this.placed[0];if(!e)return;let t=this.placed.reduce((e,t)=>e+vb(t.motion).length,0);!e.segment&&t>0&&(this.trails=new sb(this.stage.fog,t,.022*this.size),this.stage.scene.add(this.trails.mesh));let{id:n,file:r}=this.store.recording.value,i=this.store.people.value.length?r:n,a=`${this.placed.length} ${e.segment!==null} ${i}`;a!==this.contentKey&&this.frameFigures(),this.contentKey=a}setPoses(e){let{store:t}=this,n=this.findLeader(),r=W(`shadow`),[i,a]=[W(`body`),W(`joint`)];this.placed.forEach((e,o)=>{let s=this.poses[o];this.placePose(e,zv(e,t.playhead.value,n),s),this.figures[o].setPose(s);let c=this.getColorAt(e,t.playhead.value),l=e.segment!==null&&e.segment===n,u=e.segment?a:c,d=l?{body:c,joint:c}:{body:i,joint:u};this.figures[o].setColors({...d,shadow:r})});let o=this.placed[0],s=this.placed.length===1&&o?.segment===null?t.ghost.value:null;o&&this.ghost.show(o.motion,s,t.present.value,t.playhead.value),this.drawTrails(),t.follow.value&&this.followLead(e)}frameFigures(){let e=this.placed[0];if(!e)return;let{playhead:t}=this.store,n=this.findLeader();this.placed.forEach((e,r)=>this.placePose(e,zv(e,t.value,n),this.poses[r]));let{ground:r}=qv(e.motion),i=this.placed.length===1;if(!i&&this.placed.every(Iv))return this.frameTogether(r);let a=this.placed.map(e=>e.placement.slot),o=Math.max(...a.map(([e])=>e))-Math.min(...a.map(([e])=>e)),s=Math.max(...a.map(([,e])=>e))-Math.min(...a.map(([,e])=>e)),[c,l]=i?this.getMiddle():[0,0],u=i?pi(e.motion,this.store.playhead.value)+.6:.12,d=new X(c,r+.5*this.size,l),f=(1.3+.5*(s/this.size))*this.size;this.stage.lookAt(d,u,o+1.25*this.size,f,s>0?.5:.22)}frameTogether(e){let t=this.getRootPositions(),[n,r]=this.getMiddle(),[i,a]=_b(t),o=Math.hypot(i,a),s=pi(this.placed[0].motion,this.store.playhead.value)+.6,c=Math.atan2(-a,i)+.15,l=Math.cos(c-s)<0?c+Math.PI:c,u=new X(n,e+.5*this.size,r),d=o>.3*this.size;this.stage.lookAt(u,d?l:s,o+1.25*this.size,1.4*this.size)}getNameTags(){let{store:e}=this;return!e.people.value.length||e.inStep.value?[]:this.placed.flatMap((t,n)=>{let r=new X().fromArray(this.poses[n],3*mi(t.motion.head));if(r.setY(gb(this.poses[n])+.06*this.size).project(this.stage.camera),Number.isNaN(r.x)||Math.abs(r.z)>1)return[];let i=t.motion===e.active.value?.motion.value;return[{name:t.name,x:(1+r.x)/2,y:(1-r.y)/2,isActive:i}]})}pick(e,t){return this.placed.map((n,r)=>{let i=3*mi(n.motion.head),a=new X().fromArray(this.poses[r],i).project(this.stage.camera);return{each:n,far:Math.hypot((a.x-e)*this.stage.camera.aspect,a.y-t)}}).sort((e,t)=>e.far-t.far).find(({far:e})=>e<.3)?.each}dispose(){this.clear(),this.stage.dispose()}placeFigures(){let{store:e}=this,t=e.active.value?.motion.value,n=e.shownCluster.value?.members??[],r=e.opened.value.flatMap(e=>{let{name:t,file:n,person:r}=e.recording.value,{value:i}=e.motion;return i?[{motion:i,name:gi(r??t),file:n}]:[]});this.size=Math.max(...r.map(e=>qv(e.motion).size),0)||1;let i=Math.min(...r.map(e=>qv(e.motion).ground));return r.length>0&&this.stage.fit(this.size,i),e.inStep.value&&t&&n.length>0?Rv(t,n,this.size):Fv(r,this.size)}findLeader(){let e=this.store.frame.value,t=this.placed.flatMap(({segment:e})=>e?[e]:[]),n=this.store.selected.value;return t.find(t=>t.start_frame<=e&&e<t.stop_frame)??t.find(e=>e.start_frame===n?.start_frame)}placePose(e,t,n){ui(e.motion,t,n),Bv(n,e.placement,mi(e.motion.head))}getRootPositions(){return this.placed.map(({motion:e},t)=>{let n=3*mi(e.head);return[this.poses[t][n],this.poses[t][n+2]]}).filter(([e,t])=>!Number.isNaN(e+t))}getMiddle(){let e=this.getRootPositions(),t=e=>e.length?(Math.min(...e)+Math.max(...e))/2:0;return[t(e.map(([e])=>e)),t(e.map(([,e])=>e))]}followLead(e){if(!this.placed.length||!this.placed.every(Iv))return;let[t,n]=this.getMiddle(),{target:r}=this.stage.controls,i=this.store.playing.value?1-Math.exp(-3*e):1;this.stage.moveTo(r.x+i*(t-r.x),r.z+i*(n-r.z))}getColorAt({motion:e},t){let{opened:n,active:r}=this.store,i=n.value.find(t=>t.motion.value===e)??r.value,a=i&&Kt(i.recording.value.segmentation,t);return xn((a&&this.store.getColor(a))??`#DDDDDD`,$i.value)}drawTrails(){if(!this.trails)return;let{playhead:e}=this.store;if(this.trails.mesh.visible=this.store.trails.value&&e.value>0,!this.trails.mesh.visible)return;let t=sb.listTimes(e.value,mb),n=this.placed.map(e=>this.computePaths(e,t)),r=this.placed.flatMap((e,r)=>{let i=t.map(t=>new wf(this.getColorAt(e,t)));return n[r].map(()=>i)});this.trails.draw(n.flat(),r,this.stage.camera.position)}computePaths(e,t){let n=vb(e.motion),r=n.map(()=>new Float32Array(3*t.length)),i=di(e.motion);return t.forEach((t,a)=>{this.placePose(e,t,i),n.forEach((e,t)=>r[t].set(i.subarray(3*e,3*e+3),3*a))}),r}clear(){this.ghost.clear();for(let e of this.figures)e.group.removeFromParent(),e.dispose();this.trails?.mesh.removeFromParent(),this.trails?.dispose(),this.trails=null}};function gb(e){let t=-1/0;for(let n=1;n<e.length;n+=3)e[n]>t&&(t=e[n]);return t}function _b(e){return e.flatMap(([t,n],r)=>e.slice(r+1).map(e=>[e[0]-t,e[1]-n])).sort((e,t)=>Math.hypot(...t)-Math.hypot(...e))[0]??[0,0]}function vb(e){let{effectors:t}=e.head;return Object.keys(t).filter(e=>e!==`head`).map(e=>t[e])}function yb(){let e=Pn(),t=R(null),n=R(null),r=R({x:0,y:0});return I(()=>{let r=t.current,i=new hb(e,r);n.current=i;let a=Eb(e,i,r);return()=>{a(),i.dispose()}},[e]),U(`div`,{class:`viewer`,inert:!e.active.value,children:[U(`canvas`,{ref:t,tabIndex:0,role:`img`,"aria-label":`Figure in 3-D. Drag or press alt and an arrow key to look from another side.`,onKeyDown:e=>Db(e,n.current),onPointerDown:({x:e,y:t})=>r.current={x:e,y:t},onClick:t=>{let{x:i,y:a}=r.current;if(Math.hypot(t.x-i,t.y-a)>4)return;let o=t.currentTarget.getBoundingClientRect();Ab(e,n.current?.pick(2*(t.x-o.left)/o.width-1,1-2*(t.y-o.top)/o.height))}}),U(Sb,{}),U(bb,{onFrame:()=>n.current?.frameFigures()})]})}function bb({onFrame:e}){let t=Pn(),n=!!t.active.value?.motion.value;return U(`div`,{class:`viewer-buttons`,children:[U(ba,{on:t.follow,title:`The camera follows the figure`,children:`Follow`}),U(ba,{on:t.trails,title:`The last paths of hands and feet`,children:`Trails`}),U(ba,{on:t.inStep,title:`All members of the selected cluster, playing in step`,disabled:t.clusters.value.length===0||!n,onClick:()=>{t.cluster.value===null&&t.selectCluster(xb(t)),t.inStep.value=!t.inStep.value},children:`In step`}),U(G,{"aria-pressed":t.ghost.value!==null,title:`Keep the repetition at the playhead as a ghost, and lay it over the others (V)`,disabled:!t.present.value||!n,onClick:()=>t.toggleGhost(),children:`Ghost`}),U(G,{onClick:e,title:`Put the camera where everything is seen`,children:`Reset view`})]})}function xb(e){let t=e.present.value?.cluster??-1;return t>=0?t:e.clusters.value[0]?.id??0}function Sb(){let e=Pn(),t=e.present.value,n=e.shownCluster.value,r=e.inStep.value&&n,i=r?[]:e.people.value,a=n?.members.length??0,o=Dt(a,`member`),s=a>24?`the first 24 of ${a} members`:o;return U(`div`,{class:`caption`,children:[i.map(e=>U(Cb,{opened:e},e.recording.value.id)),t&&!i.length&&U(`p`,{children:[U(wa,{color:e.getColor(t)}),` `,$t(t)]}),e.ghost.value&&!r&&U(`p`,{class:`quiet`,children:[`ghost: `,$t(e.ghost.value),` of `,pn(e.ghost.value.start_s,2)]}),r&&U(`p`,{class:`quiet`,children:[s,` in step`]}),!r&&e.opened.value.length>Math.max(i.length,1)&&U(`p`,{class:`quiet`,children:e.opened.value.map(e=>e.recording.value.name).join(` · `)})]})}function Cb({opened:e}){let t=Pn(),{person:n,name:r,segmentation:i}=e.recording.value,a=Kt(i,t.playhead.value),o=gi(n??r);return U(`p`,{children:[U(wa,{color:a&&t.getColor(a)}),` `,e===t.active.value?U(`strong`,{children:o}):o,` `,U(`span`,{class:`quiet`,children:a&&$t(a)})]})}var wb=Math.PI/24,Tb=400;function Eb(e,t,n){let r=new jb(n.parentElement),i={figures:!0,paint:!0,picture:!0,edges:!1},a,o=(...e)=>{for(let t of e)i[t]=!0;ra.request()},s=()=>{clearTimeout(a),a=setTimeout(()=>o(`edges`),Tb)},c=()=>o(`picture`),l=new ResizeObserver(()=>{let{clientWidth:e,clientHeight:r}=n.parentElement;t.stage.resize(e,r),o(`picture`)});l.observe(n.parentElement),t.stage.controls.addEventListener(`change`,c);let u=[ct(()=>{Ob(e),o(`figures`,`picture`)}),ct(()=>{$i.value,o(`paint`,`picture`)}),ct(()=>{Qi.value,o(`edges`)}),ct(()=>{kb(e),o(`picture`)}),ra.add(n=>{if(i.figures&&t.populate(),i.paint&&t.stage.setColors(),!e.active.value||!i.picture&&!i.edges)return;let a=i.picture;a&&t.setPoses(n),i.figures=i.paint=i.picture=i.edges=!1,t.stage.draw(a&&!Qi.peek(),n),r.show(t.getNameTags()),a&&s()})];return()=>{for(let e of u)e();l.disconnect(),r.dispose(),clearTimeout(a)}}function Db(e,t){let n={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,-1],ArrowDown:[0,1]}[e.key];e.altKey&&n&&t&&(e.preventDefault(),e.stopPropagation(),t.stage.orbit(wb*n[0],wb*n[1]))}function Ob(e){for(let t of e.opened.value)t.motion.value;e.current.value,e.inStep.value&&e.shownCluster.value}function kb(e){e.playhead.value,e.primitives.value,e.selected.value;for(let{recording:t}of e.opened.value)t.value;e.trails.value,e.follow.value,e.ghost.value}function Ab(e,t){if(!t)return;if(t.segment)return e.select(t.segment);let n=e.opened.value.findIndex(e=>e.motion.value===t.motion);n>=0&&n!==e.current.value&&e.show(n)}var jb=class{place=document.createElement(`div`);constructor(e){this.place.className=`name-tags`,this.place.ariaHidden=`true`,e.append(this.place)}show(e){let{place:t}=this;for(;t.children.length>e.length;)t.lastChild.remove();for(;t.children.length<e.length;)t.append(document.createElement(`span`));e.forEach(({name:e,x:n,y:r,isActive:i},a)=>{let o=t.children[a];o.textContent!==e&&(o.textContent=e),o.classList.toggle(`front`,i),o.style.left=`${100*n}%`,o.style.top=`${100*r}%`})}dispose(){this.place.remove()}};function Mb({close:e}){let{session:t}=H(),[n,r]=Aa(),{presets:i=[],annotations:a=[]}=t.state.value??{},o=(n,i)=>r(n,async()=>{await t.comparisons.compare(i)&&e()});return U(ka,{title:`Compare with another result`,close:e,children:[U(`p`,{class:`quiet`,children:`Its segments are laid below the shown ones, with how well they agree.`}),U(`h2`,{children:`Several people’s labels, over the folder`}),U(Pb,{close:e}),U(`h2`,{children:`What a preset finds`}),U(Va,{class:`methods`,rows:i.map(({name:e,help:t})=>({key:e,cells:[U(ja,{name:e,busy:n,work:()=>o(e,{preset:e})}),U(`span`,{class:`quiet`,children:t})]}))}),U(`h2`,{children:`A label file of the folder`}),U(`div`,{class:`choices`,children:[a.map(({id:r,name:i})=>U(`span`,{class:`group`,children:[U(ja,{name:i,busy:n,work:()=>o(i,{annotation:r})}),U(G,{"aria-label":`Work on ${i}: it becomes the table`,title:`It becomes the table you work on; the present one is kept in History`,disabled:n!==``,onClick:()=>{t.edited.value?.edit({kind:`take_labels`,annotation:r}),e()},children:`Work on it`})]},r)),a.length===0&&U(`p`,{class:`quiet`,children:[`There is none in `,t.state.value?.folder,`. Put a segment table or a label file there (CSV, JSON, ELAN, Praat, Audacity, …), or drop it on this page.`]})]})]})}var Nb=`tables`;function Pb({close:e}){let{session:t,view:n}=H(),r=V([]),i=V(new Set),[a,o]=Aa();I(()=>{t.notifications.attempt(`agreement`,async()=>{let e=await t.api.loadAnnotators(),n=e.filter(({id:e})=>e!==Nb);r.value=e,i.value=new Set((n.length>1?n:e).map(({id:e})=>e))})},[t,r,i]);let s=async()=>{await t.people.compare([...i.value])&&(n.tab.value=`compare`,n.folder.value=null,e())};return r.value.length<2?U(`p`,{class:`quiet`,children:`None yet. Put the label files of each person into a folder of its own here (anna/walk.eaf), or their names behind that of the recording (walk.anna.eaf).`}):U(`div`,{class:`choices`,children:[U(`fieldset`,{class:`people`,children:r.value.map(({id:e,name:t,recordings:n})=>U(Da,{checked:i.value.has(e),onCheck:()=>i.value=Ma(i.value,e),children:[t,` `,U(`span`,{class:`quiet`,children:Dt(n,`recording`)})]},e))}),U(G,{class:`primary`,disabled:a!==``||i.value.size<2,onClick:()=>void o(`people`,s),busy:a!==``,children:[`Compare `,i.value.size,` people`]})]})}function Fb({close:e}){let{session:t}=H(),n=V(null),r=t.edited.value;I(()=>{r&&t.notifications.attempt(`versions`,async()=>{n.value=(await t.api.loadVersions(r.id)).versions})},[r,t,n]);let i=r?.confirmed.value.fps??1,a=n=>t.notifications.attempt(`versions`,async()=>{let i=await t.api.loadVersion(r.id,n.number);t.comparisons.showBelow({...i,name:`Version ${n.number}`},!0),e()});return U(ka,{title:`Tables that were replaced`,close:e,children:[U(`p`,{class:`quiet`,children:`Every table that another one took the place of is kept. Undo goes back edit by edit; here, whole tables come back, and what is shown now is kept in turn.`}),n.value?.length===0&&U(`p`,{children:`No table of this recording has been replaced yet.`}),U(Va,{class:`formats versions`,rows:(n.value??[]).map(t=>({key:t.number,cells:[U(`span`,{class:`quiet`,children:new Date(t.at).toLocaleString()}),U(S,{children:[t.edit?`last: ${qn(t.edit,i)}`:`as it was found`,U(`br`,{}),U(`span`,{class:`quiet`,children:[Dt(t.segments,`segment`),`, `,Dt(t.names,`name`),`,`,` `,Dt(t.corrections,`correction`)]})]}),U(`span`,{class:`group`,children:[U(G,{onClick:()=>void a(t),children:`Look`}),U(G,{onClick:()=>{r?.edit({kind:`restore`,version:t.number}),e()},children:`Bring back`})]})]}))})]})}var Ib={new:``,corrected:`✎`,labelled:`◐`,checked:`✓`};function Lb(){let{session:e,view:t}=H(),{search:n,status:r,order:i}=e.list,a=e.state.value?.recordings??[],o=e.list.listed.value,s=a.filter(t=>e.list.getStatus(t)===`checked`).length;return U(`section`,{class:`folder-panel`,"aria-label":`Recordings`,children:[U(`div`,{class:`panel-head`,children:[U(`h2`,{children:`Recordings`}),U(`span`,{class:`spacer`}),a.length>1&&U(G,{title:`All recordings with their segments, and how far each is`,onClick:()=>t.folder.value=!0,children:`Folder`}),U(Vb,{})]}),a.length>1&&U(`div`,{class:`folder-filter`,children:[U(Ta,{type:`search`,placeholder:`Search`,"aria-label":`Search the recordings`,value:n}),U(Ea,{label:`Show recordings that are`,value:r.value,options:Li,onSelect:e=>r.value=e}),U(Ea,{label:`Order of the recordings`,value:i.value,options:Ri,onSelect:e=>i.value=e})]}),s>0&&U(`p`,{class:`quiet note`,children:[s,` of `,a.length,` checked`]}),U(`ul`,{class:`recordings`,children:o.map(e=>U(Rb,{listing:e},e.id))}),U(zb,{all:a.length,found:o.length,suffixes:e.state.value?.suffixes})]})}function Rb({listing:e}){let{session:t,view:n}=H(),{id:r,name:i}=e,{store:a}=t,o=a.opened.value[a.findIndex(r)]?.recording.value,s=o!==void 0,c=t.list.getStatus(e),l=o?Lt(o.segmentation):e.checked,u=o?.segmentation.segments.length??e.segments,d=[Bb(e.bytes),c,...c===`corrected`?[`${l} of ${u} segments checked`]:[],...e.named?[`${e.named} with a name`]:[]],f=a.recording.value?.id===r,p=t.opening.value===r,m=a.opened.value.length>1;return U(`li`,{class:f?`current`:``,children:[U(G,{class:`recording`,"aria-current":f?`true`:void 0,"aria-busy":p,title:`${i}: ${d.join(`, `)}`,onClick:()=>{n.folder.value=null,t.open(r,{beside:s})},children:[U(Ub,{name:i}),p?U(`span`,{class:`busy`}):U(`span`,{"aria-hidden":`true`,children:Ib[c]})]}),s&&m?U(Ca,{label:`Close ${i}`,title:`Close`,onClick:()=>t.close(r)}):!s&&a.opened.value.length>0&&U(G,{class:`icon`,"aria-label":`Show ${i} beside the others`,title:`Show beside the others`,onClick:()=>void t.open(r,{beside:!0}),children:`+`})]})}function zb(e){let{all:t,found:n,suffixes:r}=e;return r?t===0?U(`p`,{class:`hint quiet`,children:[`No recordings here yet. Drop files on this page (`,r.join(`, `),`), or choose them with “Add…”.`]}):n===0?U(`p`,{class:`hint quiet`,children:`No name holds that text.`}):null:U(`p`,{class:`hint quiet`,children:`The list of recordings is loading.`})}function Bb(e){return e<1e6?`${Math.ceil(e/1e3)} kB`:`${(e/1e6).toFixed(1)} MB`}function Vb(){let{uploads:e}=H();return U(S,{children:[U(`label`,{class:`button`,title:`Add files to the folder; dropping them on the page does the same`,children:[`Add…`,U(`input`,{class:`unseen`,type:`file`,multiple:!0,onChange:t=>{let n=t.currentTarget;e.add([...n.files??[]]),n.value=``}})]}),e.running.value.map(({name:e,share:t})=>U(`span`,{class:`upload`,children:[U(`span`,{children:e}),U(`progress`,{value:t.value,"aria-label":`Sending ${e}`})]},e))]})}var Hb=12;function Ub({name:e}){let t=Math.max(e.length-Hb,0);return U(`span`,{class:`name halves`,children:[U(`span`,{children:e.slice(0,t)}),U(`span`,{children:e.slice(t)})]})}function Wb(){let{session:e}=H(),t=e.opening.value,n=e.state.value?.recordings.find(e=>e.id===t),r=V(0);return I(()=>{r.value=0;let e=window.setInterval(()=>r.value+=1,1e3);return()=>window.clearInterval(e)},[t,r]),!n||r.value===0?null:U(`p`,{class:`opening`,children:[`Reading `,n.name,`, `,Bb(n.bytes),`: `,r.value,` s`,` `,U(G,{onClick:()=>e.stopOpening(),children:`Cancel`})]})}function Gb(){let{session:e,uploads:t}=H(),n=V(!1);return I(()=>{let e=e=>e.dataTransfer?.types.includes(`Files`)??!1;return Mt(window,{dragover:t=>{e(t)&&(t.preventDefault(),n.value=!0)},dragleave:e=>{e.relatedTarget===null&&(n.value=!1)},drop:r=>{e(r)&&(r.preventDefault(),n.value=!1,t.add([...r.dataTransfer?.files??[]]))}})},[t,n]),n.value?U(`div`,{class:`drop-zone`,"aria-hidden":`true`,children:U(`p`,{children:[`Drop to add to `,e.state.value?.folder]})}):null}function Kb(){let{session:e,view:t}=H(),n=e.comparisons.comparison.value,r=e.people.agreement.value;return!n&&r?U(Qb,{agreement:r}):n?U(qb,{title:n.name,stop:()=>e.comparisons.stop(),children:[!!n.differences?.length&&U(Jb,{comparison:n}),U(Va,{class:`scores number`,rows:Object.entries(n.scores).map(([e,t])=>{let r=n.meanings?.[e];return{key:e,head:U(S,{children:[r?.title??e.replaceAll(`_`,` `),r&&U(`small`,{class:`quiet`,children:r.help})]}),cells:[t.toFixed(3)]}})}),U(`p`,{class:`quiet`,children:`Scores and differences are of the table as it was when you compared.`})]}):U(`div`,{class:`compare-panel`,children:[U(`p`,{class:`quiet`,children:`Lay another preset’s result, or what one or more people say, below this one.`}),U(`p`,{children:U(G,{disabled:!e.edited.value,onClick:()=>t.show(`compare`),children:`Compare…`})})]})}function qb(e){return U(`div`,{class:`compare-panel`,children:[U(`div`,{class:`panel-head`,children:[U(`b`,{class:`name`,children:e.title}),U(`span`,{class:`spacer`}),U(G,{onClick:e.stop,children:`Stop comparing`})]}),e.children]})}function Jb({comparison:e}){let t=Pn(),n=[t.activities.value,zt(e.segmentation,`activity`)],r=(e.differences??[]).map(([e,r])=>{let i=t.getFrameAt((e+r)/2);return{start_s:e,stop_s:r,labels:n.map(e=>Wt(e,i)).map(e=>e?$t(e):``)}});return U(Yb,{caption:`Where they differ`,names:[`This table`,e.name],differences:r})}function Yb(e){let{caption:t,names:n,differences:r}=e,i=Pn(),a=r.map(({start_s:e,stop_s:t,labels:n})=>({key:e,cells:[U(G,{onClick:()=>i.seek(e),children:pn(e,2)}),(t-e).toFixed(2),...n.map(e=>e||`–`)]}));return U(S,{children:[U(Va,{class:`differences number`,caption:t,columns:[`From`,`Seconds`,...n],rows:a}),a.length===0&&U(`p`,{children:`Nowhere for more than 0.25 s.`})]})}var Xb=`Names are compared, in capitals or small letters.`,Zb=`Names are missing or differ, so one person’s stand for another’s as they agree best.`;function Qb({agreement:e}){let{session:t}=H(),n=t.people.recordingAgreement.value;return U(qb,{title:`${e.annotators.length} people`,stop:()=>t.people.stop(),children:[U(`p`,{class:`quiet`,children:[e.by_names?Xb:Zb,` 1 is equal; of kappa, 0 is what chance gives.`]}),U($b,{agreement:e}),n&&U(Yb,{caption:`Where they differ in this recording`,names:n.annotators,differences:n.differences}),e.recordings.length>1&&U(ex,{agreement:e}),e.failures.map(e=>U(`p`,{class:`quiet`,children:e},e)),U(`p`,{class:`quiet`,children:`All this is of the labels as they were when you compared.`})]})}function $b({agreement:e}){let t=e.recordings.filter(t=>t.annotators.length===e.annotators.length),n=e.pairs.map(({annotators:e,cohen_kappa:t,border_f1:n,recordings:r})=>({key:e.join(),head:e.join(`, `),cells:[tx(t),tx(n),r]})),r={key:`all`,head:U(S,{children:[`All `,U(`small`,{class:`quiet`,children:`Fleiss’ kappa`})]}),cells:[tx(e.fleiss_kappa),``,t.length]};return U(Va,{class:`scores number`,caption:`Over the folder`,columns:[``,[`Cohen’s kappa`,`Frames that both say the same of, beyond what chance would give`],[`Border F1`,`Borders of either that the other has within 0.25 s`],`Recordings`],rows:[...n,r]})}function ex({agreement:e}){let{session:t}=H();return U(Va,{class:`differences number`,caption:`By recording`,columns:[`Recording`,`Fleiss’ kappa`,`Differences`],rows:e.recordings.map(({id:e,name:n,fleiss_kappa:r,differences:i})=>({key:e,cells:[U(G,{class:`halves`,title:n,"aria-current":e===t.store.recording.value?.id,onClick:()=>void t.open(e),children:U(Ub,{name:n})}),tx(r),i.length]}))})}function tx(e){return e===null?`–`:e.toFixed(3)}var nx=[[``,`activities and primitives, if it holds both`],[`activity`,`activities alone`],[`primitive`,`primitives alone`]];function rx({close:e}){let{session:t}=H(),n=V(``),r=V(`one`),[i,a]=Aa(),o=t.state.value?.recordings??[],s=o.filter(e=>t.list.getStatus(e)===`checked`).length,c=e=>a(e,async()=>{let{api:i,notifications:a}=t,o=t.edited.value?.id;o&&await a.attempt(`export`,async()=>Sr(r.value===`all`?await i.exportAll(e,n.value):await i.exportSegments(o,e,n.value)))}),l=[[`one`,`this recording`],[`all`,`every recording that is checked (${s} of ${o.length}), as one ZIP`,s===0]];return U(ka,{title:`Write the segments as a file`,close:e,children:[U(Oa,{name:`level`,value:n.value,options:nx,onSelect:e=>n.value=e}),U(Oa,{name:`of`,value:r.value,options:l,onSelect:e=>r.value=e}),U(Va,{class:`formats`,rows:(t.state.value?.export_formats??[]).map(({name:e,suffix:t,help:n})=>({key:e,cells:[U(ja,{name:e,busy:i,"data-format":e,work:()=>c(e)}),U(`span`,{class:`quiet`,children:t}),n]}))})]})}function ix({all:e=!1}){let{poses:t,session:n}=H(),{value:r}=t.progress,{value:i}=t.videos,{value:a}=t.requestedVideo,{value:o}=t.install,s=e=>void t.start(e.map(({id:e})=>e));if(!(e?i.length>0||r:a))return null;let c=e?Dt(i.length,`video`):a.name,l=e&&i.length!==1?`have`:`has`;return U(`div`,{class:`poses-offer ${e?`of-folder`:`of-video`}`,children:[r?U(S,{children:[U(ax,{...r}),U(G,{onClick:()=>void t.cancel(),children:`Cancel`})]}):U(`p`,{children:[c,` `,l,` no poses yet.`,` `,o?`${o}.`:`Estimating them can take some minutes; everything stays on this machine.`]}),!r&&!o&&U(G,{class:`primary`,onClick:()=>s(e?i:[a]),children:`Estimate poses`}),!r&&!o&&!e&&i.length>1&&U(G,{onClick:()=>s(i),children:[`Of all `,i.length,` videos`]}),!e&&!r&&n.store.active.value&&U(G,{onClick:()=>n.videoWithoutPoses.value=null,children:`Not now`})]})}function ax({name:e,share:t,pace:n,done:r,all:i}){return U(`p`,{role:`status`,children:[`Estimating the poses in `,e,`: `,t===null?``:`${Math.round(100*t)} %, `,n?`${n.toFixed(1)} frames/s`:`starting`,i>1&&`; ${r} of ${i} videos done`,U(`progress`,{max:1,...t===null?{}:{value:t},"aria-label":`Poses`})]})}var ox=100;function sx(){let{session:e,review:t}=H(),{store:n}=e,r=n.table.value;if(!r)return U(`p`,{class:`hint quiet`,children:`Open a recording to look through its segments.`});let i=t.doubts.value,a=t.present.value,o=(e.state.value?.recordings.length??0)>1&&U(`label`,{class:`field`,children:[`Look through`,` `,U(Ea,{value:t.everywhere.value?`folder`:`recording`,options:[[`recording`,`this recording`],[`folder`,`all recordings`]],onSelect:e=>void t.setEverywhere(e===`folder`)})]});return t.everywhere.value?U(cx,{scope:o}):U(`div`,{class:`review-panel`,children:[o,U(ux,{title:`Activities`,of:Nr(r,`activity`)}),U(ux,{title:`Primitives`,of:Nr(r,`primitive`)}),U(`p`,{class:`actions`,children:U(dx,{})}),U(`p`,{class:`why`,role:`status`,children:a?a.confidence.why:i.length?`“Next” goes to where confidence is lowest.`:`Every segment of this recording is checked.`}),U(lx,{places:i.map(e=>({doubt:e})),isCurrent:({doubt:e})=>e===a,getColor:e=>n.getColor(e),go:({doubt:e})=>n.showSegment(e.segment)})]})}function cx({scope:e}){let{review:t}=H(),{folder:n,queue:r}=t,i=n.unsegmented.value.length;return U(`div`,{class:`review-panel`,children:[e,U(lx,{places:r.places.value,isCurrent:e=>e===r.current.value,getColor:({cluster:e})=>_n(e),go:e=>void r.goTo(e)}),i>0&&U(`p`,{class:`quiet note`,children:[i,` recordings are not segmented yet`]})]})}function lx(e){let{places:t,isCurrent:n,getColor:r,go:i}=e;return U(S,{children:[U(`ol`,{class:`doubts`,children:t.slice(0,ox).map(e=>{let{segment:t,confidence:a}=e.doubt;return U(`li`,{children:U(G,{class:`plain`,"aria-current":n(e)?`true`:void 0,title:a.why,onClick:()=>i(e),children:[U(wa,{color:r(t)}),U(`span`,{class:`name`,children:[$t(t),` `,U(`span`,{class:`quiet`,children:t.level})]}),U(`span`,{class:`number quiet`,children:pn(t.start_s,2)}),U(`span`,{class:`number`,children:a.short||`–`}),e.recording&&U(`span`,{class:`of quiet`,children:e.recording})]})},`${e.id} ${Ut(t)}`)})}),t.length>ox&&U(`p`,{class:`quiet note`,children:[`and `,t.length-ox,` more`]})]})}function ux({title:e,of:[t,n]}){return n?U(`p`,{class:`progress`,children:[U(`span`,{children:e}),U(`progress`,{max:n,value:t,"aria-label":`${e} checked`}),U(`span`,{class:`number`,children:[t,` of `,n]})]}):null}function dx(){let{review:e}=H();return U(S,{children:[U(G,{title:`Next to look at (J)`,onClick:()=>void e.goToNext(),children:`Next`}),U(G,{class:`primary`,title:`The segment is right: mark it and go on (K)`,onClick:()=>e.checkAndGoOn(),children:`Checked, next`})]})}function fx(){let{session:e,review:t}=H(),{current:n}=t.queue;if(!t.everywhere.value)return null;let r=n.value,i=r?.id===e.store.recording.value?.id;return U(`section`,{class:`queue-bar`,"aria-label":`Review of all recordings`,children:[U(`p`,{class:`queue-why`,role:`status`,children:r?U(S,{children:[U(`strong`,{children:[r.recording,`, `,pn(r.doubt.segment.start_s,2),`:`,` `,$t(r.doubt.segment),`.`]}),` `,i?r.doubt.confidence.why:`Opening…`]}):`Every segment of every recording is checked.`}),U(px,{tally:t.folder.tally.value}),U(`span`,{class:`group`,children:[U(dx,{}),U(Ca,{label:`Leave the queue of the folder`,onClick:()=>void t.setEverywhere(!1)})]})]})}function px({tally:e}){let{all:t,checked:n,doubtful:r}=e;return t?U(`p`,{class:`folder-progress`,children:[U(`progress`,{max:t,value:n,"aria-label":`Segments of the folder checked`}),U(`span`,{class:`number`,title:`Segments that nobody checked and that are more probably wrong than right`,children:[n.toLocaleString(`en`),` of `,t.toLocaleString(`en`),` checked;`,` `,r.toLocaleString(`en`),` of the others below 50 %`]})]}):null}var mx=`.layout > :not(.place-header)`,[hx,gx]=[30,26],_x=480,vx=40;function yx(){let{session:e,view:t}=H(),n=new Set(e.state.value?.recordings.map(e=>e.file)).size>1,r=e.question.value!==``||e.videoWithoutPoses.value,i=!e.store.opened.value.length&&!e.opening.value&&!r;return t.folder.value??(n&&i)?U(bx,{}):null}function bx(){let{session:e,review:t,view:n}=H(),{folder:r}=t,{list:i}=e,a=V([`name`,!1]),o=V(1/0),s=V(vx),c=innerHeight>_x?hx:gx,{ref:l,onScroll:u,from:d,to:f}=Ha(c),p=Oe(()=>B(()=>Fx(r.members.value.filter(({listing:e})=>i.matches(e)).map(e=>Px(e,i.getStatus(e.listing))),...a.value)),[r,i,a]);I(()=>{r.refresh();let e=document.querySelector(`.place-header`);scrollTo(0,0);let t=new ResizeObserver(()=>{o.value=l.current?.clientWidth??1/0,s.value=e?.getBoundingClientRect().bottom??vx});for(let n of[l.current,e,document.querySelector(`.notices`)])n&&t.observe(n);return()=>t.disconnect()},[r,l,o,s]),xx();let m=Nx(kx,o.value),[h,g]=Mx(m),_={"--columns":h,"--least":`${g}px`,"--row":`${c}px`,"--head":`${s.value}px`},v=e.store.opened.value.length>0;return U(`section`,{class:`folder-page`,"aria-label":`Folder`,style:_,children:[U(`div`,{class:`folder-tools`,children:[U(`h2`,{children:e.state.value?.folder.split(/[\\/]/).at(-1)}),U(px,{tally:r.tally.value}),U(`span`,{class:`spacer`}),U(Vb,{}),U(Sx,{}),U(G,{class:`primary`,title:`Through all recordings, what has the lowest confidence first (J)`,onClick:()=>void t.setEverywhere(!0),children:`Review all recordings`}),v&&U(G,{onClick:()=>n.folder.value=null,children:`Back to the recording`})]}),U(ix,{all:!0}),U(`div`,{class:`folder-tools`,children:[U(Ta,{type:`search`,placeholder:`Filter by name`,"aria-label":`Filter the recordings by name`,value:i.search}),U(Ea,{label:`Recordings that are`,value:i.status.value,options:Li,onSelect:e=>i.status.value=e}),U(`span`,{class:`quiet number`,role:`status`,children:[p.value.length,` of `,r.members.value.length,` recordings`]})]}),U(`div`,{ref:l,class:`folder-rows`,role:`table`,"aria-label":`Recordings of the folder`,"aria-rowcount":p.value.length+1,tabIndex:0,onScroll:u,children:[U(`div`,{role:`row`,class:`folder-row folder-head`,"aria-rowindex":1,children:m.map(({id:e,title:t,help:n})=>{let[r,i]=a.value;return U(`span`,{role:`columnheader`,"aria-sort":r===e?i?`descending`:`ascending`:`none`,children:U(Ua,{order:a,column:e,title:t,tooltip:`${n}; order by it`})},e)})}),U(`div`,{role:`rowgroup`,style:{height:`${p.value.length*c}px`},children:p.value.slice(d,f).map((e,t)=>U(Tx,{row:e,at:d+t,top:(d+t)*c,columns:m.map(({id:e})=>e)},e.listing.id))})]})]})}function xx(){let{session:e,review:t,view:n}=H(),{store:r}=e,i=R(!0);Et(()=>{r.recording.value?.id,t.queue.current.value,i.current||(n.folder.value=null),i.current=!1}),L(()=>{let e=[...document.querySelectorAll(mx)];for(let t of e)t.inert=!0;let i=Mt(window,{keydown:e=>{r.recording.peek()&&!document.querySelector(`dialog[open]`)&&(e.stopPropagation(),e.key===`Escape`&&(n.folder.value=null),e.key===`j`&&cc(e)&&t.setEverywhere(!0))}},{capture:!0});return()=>{for(let t of e)t.inert=!1;i()}},[r,t,n])}function Sx(){let{review:e}=H(),{folder:t}=e,{value:n}=t.segmenting,{length:r}=t.unsegmented.value;return n?U(`span`,{class:`quiet number`,role:`status`,children:[U(`span`,{class:`busy`}),` segmenting `,n.done+1,` of `,n.all,`…`]}):!r||!t.isReady.value?null:U(G,{title:`Find the segments of the recordings that have none yet; they are saved once you edit them`,onClick:()=>void t.segmentAll(),children:[`Segment `,Dt(r,`recording`)]})}var Cx=2,wx={name:[({listing:e})=>e.name,e=>U(Ex,{row:e})],strip:[Ix,e=>U(Dx,{row:e})],length:[Ix,e=>e.table?pn(Ix(e),0):``],rate:[({table:e})=>e&&e.fps,({table:e})=>e?`${Number(e.fps.toFixed(2))} Hz`:``],activities:[({activities:e})=>e,({activities:e})=>e],primitives:[({primitives:e})=>e,({primitives:e})=>e],checked:[({tally:e})=>e&&e.checked/Math.max(e.all,1),({tally:e})=>e&&U(S,{children:[U(`progress`,{max:e.all,value:e.checked,"aria-hidden":`true`}),` `,Math.floor(100*e.checked/Math.max(e.all,1)),` %`]})],least:[({least:e})=>e,e=>U(Ox,{row:e})],notes:[({comments:e})=>e||null,({comments:e})=>e||null],status:[({status:e})=>Ii.indexOf(e),({status:e})=>e]};function Tx(e){let{row:t,at:n,top:r,columns:i}=e,{session:a}=H();return U(`div`,{role:`row`,class:a.store.recording.value?.id===t.listing.id?`folder-row current`:`folder-row`,"aria-rowindex":n+2,style:{top:`${r}px`},children:i.map(e=>U(`span`,{role:e===`name`?`rowheader`:`cell`,class:`cell ${e}`,children:wx[e][1](t)},e))})}function Ex({row:{listing:e}}){let{session:t,view:n}=H(),r=t.opening.value===e.id;return U(G,{class:`plain name`,"aria-label":`Open ${e.name}`,title:`Open ${e.name}`,"aria-busy":r,onClick:()=>void t.open(e.id).then(()=>n.folder.value=null),busy:r,children:U(Ub,{name:e.name})})}function Dx({row:{table:e}}){let{review:t}=H();return e?U(`span`,{class:`gradient`,style:{background:zr(e)}}):U(`span`,{class:`quiet`,children:t.folder.isReady.value?`not segmented yet`:``})}function Ox({row:{listing:e,table:t}}){let{review:n,view:r}=H(),{id:i,name:a}=e;return U(S,{children:(t?Ir(t).slice(0,Cx):[]).filter(({confidence:e})=>e.value!==null).map(e=>U(G,{class:`plain`,title:`${$t(e.segment)}. ${e.confidence.why}`,onClick:()=>{n.queue.goTo({id:i,recording:a,doubt:e}).then(()=>r.folder.value=null)},children:[e.confidence.short,` `,U(`span`,{class:`quiet`,children:[`at `,pn(e.segment.start_s,1)]})]},Ut(e.segment)))})}var kx=[{id:`name`,title:`Recording`,least:170,share:1.4,help:`Its file`},{id:`strip`,title:`Segments in time`,least:120,share:3,help:`Its activities, in the colours of their clusters`},{id:`length`,title:`Length`,least:64,help:`Minutes and seconds`},{id:`rate`,title:`Rate`,least:64,help:`Frames per second`},{id:`activities`,title:`Activities`,least:66,help:`How many it has`},{id:`primitives`,title:`Primitives`,least:68,help:`Repetitions, and what else recurs`},{id:`checked`,title:`Checked`,least:92,help:`How much of its table somebody checked, activities, primitives and transitions`},{id:`least`,title:`Lowest confidence`,least:212,help:`The places of lowest confidence that nobody has checked`},{id:`notes`,title:`Notes`,least:54,help:`Comments on its segments`},{id:`status`,title:`Status`,least:78,help:`New, corrected, labelled or checked`}],Ax=10,jx=[`rate`,`length`,`notes`,`status`,`primitives`,`activities`];function Mx(e){return[e.map(({least:e,share:t})=>t?`minmax(${e}px, ${t}fr)`:`${e}px`).join(` `),e.reduce((e,{least:t})=>e+t+Ax,Ax)]}function Nx(e,t){let n=e;for(let e of jx){if(Mx(n)[1]<=t)break;n=n.filter(t=>t.id!==e)}return n}function Px(e,t){let{table:n}=e;return{...e,status:t,tally:n&&Lr(n),activities:n&&It(n,`activity`),primitives:n&&It(n,`primitive`),least:n&&Rr(n)}}function Fx(e,t,n){let r=n?-1:1,i=new Map(e.map(e=>[e,wx[t][0](e)]));return[...e].sort((e,t)=>{let[n,a]=[i.get(e),i.get(t)];return n===null||a===null?Number(n===null)-Number(a===null):typeof n==`string`?r*n.localeCompare(String(a),`en`):r*(n-Number(a))})}function Ix({table:e}){return e&&e.n_frames/e.fps}var Lx=z(!1),Rx=120;function zx(){let{session:e}=H(),t=e.state.value,n=e.edited.value;return t&&n&&U(Bx,{edited:n,state:t},n.id)}function Bx({edited:e,state:t}){let{session:n}=H(),{draft:r}=n.comparisons,i=V(!0),a=R(0),{revision:o,segmentation:s,motion:c}=e.confirmed.value,l=c===null?t.presets.map(e=>({...e,parameters:e.signal_parameters})):t.presets,u=n.comparisons.proposal.value,d=n.segmenting.value,f=Vx(s,l,t.default_preset),{preset:p,values:m,detail:h}=r.value??u?.choice??f,g=l.find(e=>e.name===p),_=typeof s.provenance.preset==`string`,v=h===1&&g.parameters.every(({name:e,value:t,step:n})=>Math.abs((m[e]??t)-t)<n/2),y=ke((e,t)=>{r.value=e,window.clearTimeout(a.current),a.current=window.setTimeout(()=>{r.peek()===e&&n.comparisons.propose(e,i.value)},t)},[n,r,i]);I(()=>()=>{window.clearTimeout(a.current),n.comparisons.cancel()},[n]),I(()=>{u&&u.revision!==o&&y(r.peek()??u.choice,0)},[u,o,y,r]);let b=({name:e,minimum:t,maximum:n},r)=>{if(!Number.isFinite(r))return;let i=Math.min(Math.max(r,t),n);y({preset:p,values:{...m,[e]:i},detail:h},Rx)},x={all:u&&!r.value?u.preview.details:t.details,detail:h,choose:e=>y({preset:p,values:m,detail:e},Rx)};return I(()=>void(n.store.levels.value=x)),I(()=>()=>void(n.store.levels.value=null),[n]),U(`section`,{class:`preset-panel`,"aria-label":`Segmentation`,"aria-busy":d,children:[U(`div`,{class:`panel-head`,children:[U(`h2`,{children:`Segmentation`}),d&&U(`span`,{class:`busy`,role:`status`,"aria-label":`Segmenting`}),U(`span`,{class:`spacer`}),U(G,{title:_?`The preset’s own values`:`Segments by this preset, to look at`,disabled:_?v:d||u!==null,onClick:()=>y({preset:p,values:Hx(g),detail:1},0),children:_?`Reset`:`Segment`})]}),d&&U(Kx,{id:e.id}),U(`div`,{class:`preset-choice`,children:[U(Ea,{label:`Preset`,value:p,options:l.map(({name:e})=>[e,e]),onSelect:e=>{let t=l.find(({name:t})=>t===e);y({preset:t.name,values:Hx(t),detail:1},0)}}),U(`p`,{class:`preset-help quiet`,children:g.help}),U(za,{}),U(`details`,{class:`advanced`,open:Lx.value,onToggle:e=>Lx.value=e.currentTarget.open,children:[U(`summary`,{children:`Advanced`}),g.parameters.map(e=>U(Wx,{parameter:e,value:m[e.name]??e.value,change:t=>b(e,t)},`${p}.${e.name}`))]})]}),u&&U(Ux,{proposal:u,keep:i.value,setKeep:e=>{i.value=e,y(u.choice,0)}})]})}function Vx(e,t,n){let{preset:r,parameters:i,detail:a}=e.provenance,o=t.find(e=>e.name===r)??t.find(e=>e.name===n),s=Hx(o);if(o.name===r&&typeof i==`object`&&i)for(let e of Object.keys(s)){let t=i[e];typeof t==`number`&&(s[e]=t)}return{preset:o.name,values:s,detail:typeof a==`number`?a:1}}function Hx(e){return Object.fromEntries(e.parameters.map(({name:e,value:t})=>[e,t]))}function Ux(e){let{session:t}=H(),{proposal:n,keep:r,setKeep:i}=e,{preview:a}=n,o=`${Dt(a.corrections,`correction`)}, ${Dt(a.names,`name`)}`,s=a.corrections+a.names>0;return U(`div`,{class:`proposed`,role:`group`,"aria-label":`Preview`,children:[U(`div`,{class:`proposed-said`,children:[s&&U(Da,{checked:r,onCheck:i,children:[`Take over `,o]}),s&&r&&a.lost.length>0&&U(`details`,{open:!0,children:[U(`summary`,{children:[Dt(a.lost.length,`name`),` would be lost`]}),U(`ul`,{children:a.lost.map(e=>U(`li`,{children:e},e))})]}),U(`p`,{class:`quiet`,children:`Shown below what is there; borders that differ are marked. Nothing has been changed.`})]}),U(`p`,{class:`actions`,children:[U(G,{onClick:()=>t.comparisons.discard(),children:`Discard`}),U(G,{class:`primary`,disabled:r!==n.keep,onClick:()=>t.comparisons.apply(),children:s?r?`Apply`:`Apply: replaces ${o}`:`Apply`})]})]})}function Wx(e){let{parameter:t,value:n,change:r}=e,{name:i,help:a,minimum:o,maximum:s,step:c,unit:l}=t,u=i.replaceAll(`_`,` `);return U(`div`,{class:`parameter`,title:a,children:[U(`label`,{for:`parameter-${i}`,children:[u,` `,U(`span`,{class:`quiet`,children:l})]}),U(Fa,{"aria-label":l?`${u} in ${l}`:u,min:o,max:s,step:Number(c.toFixed(3)),value:Number(n.toFixed(3)),onNumber:r}),U(`input`,{id:`parameter-${i}`,type:`range`,min:o,max:s,step:c,value:n,onInput:e=>r(e.currentTarget.valueAsNumber)})]})}var Gx=400;function Kx({id:e}){let{session:t}=H(),n=V(null);if(I(()=>{let r=window.setInterval(()=>{t.api.loadProgress(e).then(e=>n.value=e,()=>void 0)},Gx);return()=>window.clearInterval(r)},[t,e,n]),!n.value?.stage)return null;let{stage:r,share:i}=n.value,a=i===null?r:`${r}, ${Math.round(100*i)} %`;return U(`div`,{class:`run-progress`,children:[U(`progress`,{"aria-label":`Segmentation`,value:i??void 0}),U(G,{title:`What is there stays (Escape)`,onClick:()=>t.cancel(),children:`Cancel`}),U(`span`,{class:`quiet`,children:a})]})}var qx=[`m`,`cm`,`mm`,`inch`,`cmu`],Jx=[`x`,`y`,`z`,`-x`,`-y`,`-z`];function Yx(){let{session:e}=H(),{value:t}=e.store.recording,{value:n}=e.unread,r=R(null),[i,a]=Aa(),o=n?.id??t?.id,s=!n&&t?.read_options||{},c=!n&&t?.takes||[],l=n?n.people:t?.people??[],u=n?[]:e.store.people.value,d=e=>{let t=s[e];return typeof t==`string`||typeof t==`number`?String(t):``},f=n?``:t?.person??d(`person`);if(!o)return null;let p=n!==null||Object.keys(s).length>0||c.length>1||l.length>0,m=(t=f,n=!1)=>{let i=Object.fromEntries(new FormData(r.current)),s={...i,fps:Number(i.fps),person:l.length?t:i.person?.trim()},c=Object.entries(s).filter(([,e])=>e),u=Object.fromEntries(c);return a(`reading`,()=>e.readAs(o,{options:u,everybody:n}))};return U(`details`,{class:`reading-panel`,open:p,children:[U(`summary`,{children:[`How `,n?n.name:`this file`,` is read`]}),U(`form`,{ref:r,onSubmit:e=>{e.preventDefault(),m()},children:[l.length>0?U(Xx,{names:l,shown:u.length?u.map(e=>e.recording.value.person??``):[f],question:n!==null,read:m}):U(Sa,{title:`Person`,tooltip:`Which of several people, by name or number`,children:U(`input`,{type:`text`,name:`person`,placeholder:`the only one`,defaultValue:f})}),c.length>1&&U(Zx,{name:`take`,title:`Take, one of ${c.length}`,none:null,values:c,value:t?.take??``,onChange:e=>e.currentTarget.form?.requestSubmit()}),U(Sa,{title:`Frames per second`,children:U(`input`,{type:`number`,name:`fps`,min:`0`,step:`any`,placeholder:`as the file says`,defaultValue:d(`fps`)})}),U(`div`,{class:`pair`,children:[U(Zx,{name:`unit`,title:`Unit`,values:qx,value:d(`unit`)}),U(Zx,{name:`up`,title:`Up`,values:Jx,value:d(`up`)})]}),!(n&&l.length>0)&&U(`p`,{class:`actions`,children:U(G,{type:`submit`,disabled:i!==``,busy:i!==``,title:`Tables are made anew; those before are kept in History`,children:`Read again`})})]})]},`${o} ${n!==null}`)}function Xx(e){let{names:t,shown:n,question:r,read:i}=e,{session:a}=H(),o=n.length===t.length;return U(`fieldset`,{class:`people-choice`,children:[U(`legend`,{children:r?`Who is to be seen?`:`People in this file`}),t.map(e=>U(G,{"aria-pressed":n.includes(e),title:`Show ${gi(e)} alone: each has a table of their own`,onClick:()=>void i(e),children:gi(e)},e)),t.length>1&&!a.state.value?.of_library&&U(G,{class:r?`primary`:``,"aria-pressed":o,title:`Show all of them together, in the same time and space`,onClick:()=>void i(void 0,!0),children:[`All `,t.length,` people`]})]})}function Zx(e){let{name:t,title:n,values:r,value:i,none:a=`as found`}=e;return U(Sa,{title:n,children:U(`select`,{name:t,defaultValue:i,onChange:e.onChange,children:[a!==null&&U(`option`,{value:``,children:a}),r.map(e=>U(`option`,{value:e,selected:e===i,children:e},e))]})})}function Qx(){let{session:e,editor:t,review:n}=H(),r=t.segment.value;if(!r)return U(`p`,{class:`hint quiet`,children:e.opening.value?`The segments come once the recording has been read.`:`Open a recording to see its segments.`});let{store:i}=e,a=i.table.value,o=a?.cluster_names[r.cluster]??``,s=r.label===o?``:r.label,c=i.selected.value===r,l=a&&new Er(a,r);return U(`div`,{class:`segment-panel`,children:[U(`p`,{class:`times number`,children:[U(wa,{color:i.getColor(r)}),` `,U(`b`,{children:$t(r)}),` `,U(`span`,{class:`quiet`,children:[r.level,` `,c?`selected`:`at the playhead`]}),U(`br`,{}),r.start_s.toFixed(2),` – `,r.stop_s.toFixed(2),` s`,` `,U(`span`,{class:`quiet`,children:[`(`,Zt(r).toFixed(2),` s)`]}),U(`br`,{}),U(`span`,{class:`quiet`,children:[`frames `,r.start_frame,` – `,r.stop_frame,l?.text&&U(`span`,{title:l.why,children:[`, `,l.text]})]})]}),U(tS,{title:`Name of its own`,placeholder:o?`called “${o}” by its cluster`:`no name`,value:s,naming:`segment`,onName:e=>t.nameSegment(r,e,a)}),U(Da,{checked:n.isChecked(r),onCheck:e=>t.setChecked([r],e),children:`Checked: no new segmentation changes it`}),U(`div`,{class:`pair`,children:[U(Sa,{title:`Kind`,children:U(Ea,{value:r.kind,options:[[r.level,r.level],[`transition`,`transition`]],onSelect:e=>t.edit({kind:`set_kind`,...Fn(r),to:e})})}),U(Sa,{title:`Cluster`,children:[U(wa,{color:_n(r.cluster)}),U($x,{segment:r})]})]}),r.cluster>=0&&U(tS,{title:`Name of cluster ${r.cluster}, of ${eS(e,r.cluster)}`,placeholder:`no name`,value:o,naming:`cluster`,onName:e=>t.edit({kind:`name_cluster`,cluster:r.cluster,label:e})}),U(rS,{segment:r,table:a}),U(aS,{})]})}function $x({segment:e}){let{session:t,editor:n}=H(),r=t.store.table.value?.segments??[],i=r.reduce((e,t)=>Math.max(e,t.cluster),-1)+1,a=new Set([-1,i,...r.map(e=>e.cluster)]),o=e=>{let n=t.store.table.value?.cluster_names[e];return e<0?`none`:e===i?`${e} (new)`:n?`${e}: ${n}`:String(e)};return U(Ea,{label:`Cluster of the segment`,value:e.cluster,options:[...a].sort((e,t)=>e-t).map(e=>[e,o(e)]),onSelect:t=>n.edit({kind:`set_cluster`,...Fn(e),cluster:t})})}function eS(e,t){let n=e.store.table.value,r=n?.cluster_names[t]??``,i=n?.segments.filter(e=>e.cluster===t)??[],a=i.filter(e=>e.label&&e.label!==r).length,o=Dt(i.length-a,`segment`);return a?`${o}; ${a} with their own name`:o}function tS({title:e,placeholder:t,value:n,naming:r,onName:i}){let{session:a,editor:o}=H(),s=R(null),c=o.naming.value===r;L(()=>{c&&(s.current?.focus(),s.current?.select(),o.naming.value=null)},[c,o]);let l=`names-${r}`;return U(Sa,{title:e,children:[U(Pa,{field:s,value:n,placeholder:t,list:l,onName:i}),U(`datalist`,{id:l,children:nS(a).map(e=>U(`option`,{value:e},e))})]})}function nS(e){let t=e.store.table.value?.segments??[];return[...new Set(t.map(e=>e.label))].filter(Boolean).sort()}function rS({segment:e,table:t}){let{editor:n}=H();return U(Sa,{title:`Comment`,children:U(`textarea`,{rows:2,placeholder:`what others should know of it`,...Na(e.comment??``,r=>n.edit({kind:`comment`,...Fn(e),text:r.trim()},t))})})}var iS=9;function aS(){let{session:e,editor:t}=H(),n=e.state.value?.labels??[],r=V(``),i=t=>e.notifications.attempt(`labels`,async()=>{await e.api.shareLabels({labels:t}),await e.refresh()});return U(`section`,{class:`vocabulary`,"aria-label":`Shared labels`,children:[U(`h2`,{children:`Labels of the folder`}),U(`div`,{class:`choices`,children:n.map((e,r)=>U(`span`,{class:`group`,children:[U(G,{title:r<iS?`Name the segment “${e}” (${r+1})`:`Name the segment “${e}”`,onClick:()=>t.nameTarget(e),children:[r<iS&&U(`kbd`,{children:r+1}),` `,e]}),U(Ca,{label:`Take “${e}” off the list`,onClick:()=>void i(n.filter(t=>t!==e))})]},e))}),U(xa,{onSubmit:()=>{let e=r.value.trim();r.value=``,e&&i([...n,e])},children:[U(Ta,{"aria-label":`A label for all recordings of the folder`,placeholder:n.length?`one more label`:`a label for the key 1`,value:r,onKeyDown:e=>e.key===`Escape`&&e.currentTarget.blur()}),U(G,{type:`submit`,children:`Add`})]})]})}var oS={level:``,kind:``,checked:``,text:``,shortest:0,longest:1/0,confidenceBelow:1/0};function sS(e,t,n,r){let i=e.segments.map((t,n)=>({segment:t,number:n,confidence:new Er(e,t)})).filter(e=>uS(e,t)),a=r?-1:1,o=fS[n];return i.sort((e,t)=>a*o(e,t)||Ht(e.segment,t.segment))}function cS(e,t,n){return e.slice(Math.min(t,n),Math.max(t,n)+1)}function lS(e){let t=[],n=e.map(({segment:e})=>e).sort(Vt);for(let{level:e,start_frame:r,stop_frame:i}of n){let n=t.at(-1);n?.level===e&&n.stop===r?(n.stop=i,n.n+=1):t.push({level:e,start:r,stop:i,n:1})}return t.filter(({n:e})=>e>1).map(({level:e,start:t,stop:n})=>({level:e,start:t,stop:n}))}function uS({segment:e,confidence:t},n){let{level:r,kind:i,text:a,shortest:o,longest:s,confidenceBelow:c}=n,l=Zt(e);return(!r||e.level===r)&&(!i||e.kind===`transition`==(i===`transition`))&&(!n.checked||!!e.checked==(n.checked===`yes`))&&dS(e,a.trim().toLowerCase())&&l>=o&&l<=s&&(c===1/0||(t.value??1/0)<c)}function dS(e,t){let n=/^cluster (\d+)$/.exec(t)?.[1];if(n!==void 0&&e.cluster===Number(n))return!0;let r=e.cluster>=0&&n===void 0?` cluster ${e.cluster}`:``;return`${n===void 0?$t(e):e.label}${r}`.toLowerCase().includes(t)}var fS={start:(e,t)=>Ht(e.segment,t.segment),duration:(e,t)=>Zt(e.segment)-Zt(t.segment),name:(e,t)=>$t(e.segment).localeCompare($t(t.segment)),confidence:(e,t)=>(e.confidence.value??2)-(t.confidence.value??2)},pS=26,mS=[[`start`,`Start`],[`duration`,`Length`],[`name`,`Name`],[`confidence`,`Confidence`]];function hS(){let{session:e,view:t}=H(),{store:n}=e,r=V(oS),i=V([`start`,!1]),a=V(new Set),o=R(0),{ref:s,onScroll:c,from:l,to:u}=Ha(pS),d=Oe(()=>B(()=>{let e=n.table.value;return e?sS(e,r.value,...i.value):[]}),[n,r,i]);Et(()=>{let e=n.selected.value,t=d.peek().findIndex(({segment:t})=>t===e);t<0||a.peek().has(d.peek()[t].number)||(a.value=new Set([d.peek()[t].number]),o.current=t,_S(s.current,t))});let f=(e,t)=>{let r=d.value[Math.min(Math.max(e,0),d.value.length-1)];if(!r)return;let i=d.value.indexOf(r);if(t===`range`){let e=cS(d.value,o.current,i);a.value=new Set(e.map(e=>e.number))}else a.value=Ma(t===`more`?a.value:new Set,r.number),o.current=i;p.current=i,t!==`more`&&n.select(r.segment),_S(s.current,i)},p=R(0),m=e=>{let t={ArrowDown:1,ArrowUp:-1}[e.key],n=e.key.toLowerCase();if(t)f(p.current+t,e.shiftKey?`range`:`one`);else if(n===`a`&&(e.ctrlKey||e.metaKey))a.value=new Set(d.value.map(e=>e.number));else return;e.preventDefault(),e.stopPropagation()},h=d.value.filter(({number:e})=>a.value.has(e));return U(`div`,{class:`segment-table`,children:[U(CS,{filter:r}),h.length>0&&U(TS,{rows:h}),U(`div`,{class:`table-head`,role:`presentation`,children:mS.map(([e,t])=>U(Ua,{order:i,column:e,title:t,tooltip:`Order by ${t.toLowerCase()}`},e))}),U(`div`,{ref:s,class:`table-rows`,role:`grid`,"aria-label":`Segments`,"aria-multiselectable":`true`,"aria-rowcount":d.value.length,tabIndex:0,onKeyDown:m,onScroll:c,children:U(`div`,{role:`presentation`,style:{height:`${d.value.length*pS}px`},children:d.value.slice(l,u).map((e,t)=>U(gS,{row:e,at:l+t,color:n.getColor(e.segment),chosen:a.value.has(e.number),go:f},e.number))})}),U(`div`,{class:`table-foot`,children:[U(`p`,{class:`quiet note`,role:`status`,title:`Click rows, with Shift or Ctrl several, to name, merge, check or write them`,children:[Dt(d.value.length,`segment`),h.length>0&&`, ${h.length} chosen`]}),U(G,{disabled:!e.edited.value||!n.recording.value?.motion,title:`Which repetitions make good loops: seam, sliding feet, turn and speed`,onClick:()=>t.show(`loops`),children:`Loops by quality…`})]})]})}function gS(e){let{row:t,at:n,color:r,chosen:i,go:a}=e,{segment:o,confidence:s}=t;return U(`div`,{role:`row`,class:o.level,"aria-selected":i,"aria-rowindex":n+1,style:{top:`${n*pS}px`},onClick:e=>a(n,e.shiftKey?`range`:e.ctrlKey||e.metaKey?`more`:`one`),children:[U(`span`,{role:`gridcell`,class:`number`,children:pn(o.start_s,2)}),U(`span`,{role:`gridcell`,class:`number`,children:Zt(o).toFixed(2)}),U(`span`,{role:`gridcell`,class:`name`,title:`${o.level}: ${$t(o)}`,children:[U(wa,{color:r}),` `,$t(o)]}),U(`span`,{role:`gridcell`,class:`number`,children:o.checked?U(`span`,{title:`checked`,children:`✓`}):U(`span`,{title:s.why,children:s.short})})]})}function _S(e,t){if(!e)return;let{scrollTop:n,clientHeight:r}=e;t*pS<n?e.scrollTop=t*pS:(t+1)*pS>n+r&&(e.scrollTop=(t+1)*pS-r)}var vS=[[``,`both levels`],[`activity`,`activities`],[`primitive`,`primitives`]],yS=[[``,`every kind`],[`movement`,`no transitions`],[`transition`,`transitions`]],bS=[[``,`checked or not`],[`no`,`not checked`],[`yes`,`checked`]],xS=[[`shortest`,`from s`,`Shortest, seconds`,`0.1`],[`longest`,`to s`,`Longest, seconds`,`0.1`],[`confidenceBelow`,`confidence <`,`Confidence below`,`0.05`]],SS=z(!1);function CS({filter:e}){let t=t=>void(e.value={...e.value,...t}),{text:n,level:r,...i}=e.value,a=Object.entries(i).some(([e,t])=>t!==oS[e]);return U(`div`,{class:`table-filter`,children:[U(`input`,{type:`search`,placeholder:`Name or cluster`,"aria-label":`Only segments with this in their name`,value:n,onInput:e=>t({text:e.currentTarget.value})}),U(Ea,{label:`Level`,value:r,options:vS,onSelect:e=>t({level:e})}),U(G,{"aria-expanded":SS.value,"aria-pressed":a,title:`Kind, checked or not, length, confidence`,onClick:()=>SS.value=!SS.value,children:`More`}),SS.value&&U(wS,{filter:e.value,change:t})]})}function wS(e){let{filter:t,change:n}=e;return U(`div`,{class:`more-filters`,children:[U(Ea,{label:`Kind of segment`,value:t.kind,options:yS,onSelect:e=>n({kind:e})}),U(Ea,{label:`Checked or not`,value:t.checked,options:bS,onSelect:e=>n({checked:e})}),U(`span`,{class:`group`,children:xS.map(([e,r,i,a])=>U(`input`,{type:`number`,min:`0`,step:a,max:e===`confidenceBelow`?1:``,placeholder:r,"aria-label":i,defaultValue:t[e]===oS[e]?``:t[e],onInput:({currentTarget:{valueAsNumber:t}})=>n({[e]:Number.isFinite(t)?t:oS[e]})},e))})]})}function TS({rows:e}){let{session:t,editor:n}=H(),[r,i]=Aa(),a=async n=>{let r=t.edited.value;r&&await t.notifications.attempt(`clips`,async()=>{await r.waitUntilSent();let{segmentation:i}=r.confirmed.value,a=e.map(({segment:e})=>Bt(i,e)).map(e=>i.segments.indexOf(e)).filter(e=>e>=0);Sr(await t.api.exportClips(r.id,{rows:a,loops:n}))})},o=e[0]?.segment.cluster??-1,s=o>=0&&e.every(({segment:t})=>t.cluster===o&&t.level===e[0]?.segment.level),c=V(``),l=lS(e),u=e.length>0&&e.every(({segment:e})=>e.checked),d=e.map(({segment:e})=>e);return U(`div`,{class:`table-actions`,children:[U(xa,{onSubmit:()=>{let e=c.value.trim(),t=d.map(t=>({kind:`name_segment`,...Fn(t),label:e}));n.sendTogether(t,`named “${e}”`)},children:[U(Ta,{"aria-label":`Name for all chosen`,placeholder:`name`,value:c}),U(G,{type:`submit`,children:[`Name `,e.length]})]}),U(G,{disabled:!l.length,title:`Neighbours become one segment`,onClick:()=>n.sendTogether(l.map(({level:e,start:t,stop:n})=>({kind:`merge`,level:e,start_frame:t,stop_frame:n})),`merged`),children:`Merge`}),U(G,{onClick:()=>n.setChecked(d,!u),children:u?`Uncheck`:`Check`}),U(G,{disabled:!s,title:`The chosen ones become a cluster of their own`,onClick:()=>n.edit({kind:`split_cluster`,cluster:o,frames:d.map(({start_frame:e})=>e)}),children:`New cluster`}),U(G,{disabled:r!==``,title:`The chosen segments as motion files`,onClick:()=>void i(`clips`,()=>a(!1)),children:`Clips…`}),U(G,{disabled:r!==``,title:`The same, each made to close, so that it can be repeated without a jerk`,onClick:()=>void i(`loops`,()=>a(!0)),children:`Loops…`})]})}function ES({close:e}){let{session:t}=H(),n=t.state.value?.knowledge_bases??[],r=V(``),i=r.value||(n[0]?.id??``),a=V(``),o=V(!0);return U(ka,{title:`Labels from a knowledge base`,close:e,children:[n.length===0?U(`p`,{children:[`There is no knowledge base in `,t.state.value?.folder,` yet. Make one below, of recordings whose segments have names.`]}):U(xa,{onSubmit:()=>{let n=Number.parseFloat(a.value);t.edited.value?.edit({kind:`transfer`,knowledge_base:i,spread:o.value,...Number.isFinite(n)&&{threshold:n}}),e()},children:[U(`p`,{class:`quiet`,children:`A knowledge base is a file of movements that have names. Each primitive without a name takes that of the most similar one in it, if it is similar enough.`}),U(Sa,{title:`Knowledge base`,children:U(Ea,{value:i,options:n.map(({id:e,name:t})=>[e,t]),onSelect:e=>r.value=e})}),U(Sa,{title:`Largest distance at which two movements are the same`,children:U(Ta,{type:`number`,min:`0.01`,max:`1`,step:`0.01`,placeholder:`as usual`,value:a})}),U(Da,{checked:o.value,onCheck:e=>o.value=e,children:`Give each cluster the name that most of its members got`}),U(`p`,{class:`actions`,children:U(G,{type:`submit`,class:`primary`,children:`Transfer labels`})})]}),U(DS,{})]})}function DS(){let{session:e}=H(),t=(e.state.value?.recordings??[]).filter(e=>e.named>0),n=V(new Set),r=V(`moves`),[i,a]=Aa(),o=()=>e.notifications.attempt(`knowledge`,async()=>{let i=t.map(({id:e})=>e).filter(e=>!n.value.has(e)),a=await e.api.makeKnowledge({name:r.value.trim(),recordings:i});e.notifications.tell(`${a.name} is in the folder: other recordings can take its names.`),await e.refresh()});return U(xa,{onSubmit:()=>void a(`knowledge`,o),children:[U(`h2`,{children:`Make a knowledge base of recordings with names`}),t.length===0&&U(`p`,{class:`quiet`,children:`No recording of the folder has names yet.`}),U(`div`,{class:`choices`,children:t.map(({id:e,name:t,named:r})=>U(Da,{checked:!n.value.has(e),onCheck:()=>n.value=Ma(n.value,e),children:[t,` `,U(`span`,{class:`quiet`,children:r})]},e))}),U(`p`,{class:`actions`,children:[U(Ta,{"aria-label":`Name of the knowledge base`,value:r}),U(G,{type:`submit`,disabled:i!==``||!r.value.trim()||!t.length,busy:i!==``,children:`Make it`})]})]})}function OS({children:e}){let{value:t}=Pn().active;if(!t?.recording.value.video)return null;let{file:n,id:r}=t.recording.value;return U(kS,{opened:t,children:e},n||r)}function kS({opened:e,children:t}){let n=Pn(),{name:r,offset_s:i,picture:a}=e.recording.value.video,o=R(null),[s]=De(()=>e.data.getVideoAddresses()),c=V(a?a.width/a.height:16/9),l=R(null),u=V(0),d=V(0),f=V(i),p=d.value>=s.length;if(I(()=>{if(p||!o.current)return;let e=l.current=new PS(n,o.current,f),t=e.start(()=>u.value+=1);return n.videoTime.value=e,()=>{t(),n.videoTime.value=null}},[n,f,u,p]),p)return U(`p`,{class:`no-film quiet`,children:s.length>1?`${r} is not beside this page, or this browser cannot play it.`:`This browser cannot play ${r}: convert it to MP4 with H.264 to see it here.`});let{motion:m}=e.recording.value,h=m?n.figureFirst.value?`small`:`large`:`beside`;return U(`figure`,{class:`video ${h}`,children:[U(`div`,{class:`picture`,style:{aspectRatio:h===`large`?`auto`:`${c.value}`},children:[U(`video`,{ref:o,src:s[d.value],muted:n.muted.value,playsInline:!0,preload:`auto`,"aria-label":`Video ${r}`,onLoadedMetadata:({currentTarget:{videoWidth:e,videoHeight:t}})=>c.value=e/(t||1),onError:()=>d.value+=1}),a&&U(aa,{label:`Keypoints`,"aria-hidden":`true`,watch:()=>{for(let e of AS(n))e.keypoints.value,e.recording.value;u.value,n.videoTime.value},draw:e=>l.current&&jS(e,n,a,l.current)})]}),h===`large`&&U(Sb,{}),U(`figcaption`,{children:[t?.(f),U(G,{"aria-pressed":!n.muted.value,title:`The sound of the video`,onClick:()=>n.muted.value=!n.muted.value,children:`Sound`}),m&&U(ba,{on:n.figureFirst,title:`The figure large and the video small, or the other way round`,children:`Figure large`})]})]})}function AS({people:e,active:t}){return e.value.length?e.value:t.value?[t.value]:[]}function jS(e,t,n,r){let{clientWidth:i,clientHeight:a}=e.canvas,o=r.getShownTime();for(let r of AS(t)){let{value:s}=r.keypoints,c=Kt(r.recording.value.segmentation,o),l=xn((c&&t.getColor(c))??`#DDDDDD`,`dark`);s&&RS(e,FS(n,i,a),s,o,l)}}var MS=.1,NS=.004,PS=class{store;video;offset;shownTime=null;mayPlay=!0;constructor(e,t,n){this.store=e,this.video=t,this.offset=n}getShownTime(){return(this.shownTime??this.video.currentTime)-this.offset.peek()+1e-6}getTime(){let{video:e}=this,t=this.store.playhead.peek()+this.offset.peek();return!this.mayPlay||e.error||t<0||e.ended||t>=e.duration?null:e.paused||e.seeking||e.readyState<3?`waiting`:e.currentTime-this.offset.peek()}start(e){let{video:t}=this,n=()=>this.syncVideo(),r=[ct(n),Mt(t,{loadedmetadata:n,seeked:n,canplay:n}),Mt(t,{seeked:e})],i=0,a=(n,{mediaTime:r})=>{this.shownTime=r,e(),i=t.requestVideoFrameCallback(a)},o=typeof HTMLVideoElement.prototype.requestVideoFrameCallback==`function`;return o?i=t.requestVideoFrameCallback(a):r.push(Mt(t,{timeupdate:e})),()=>{for(let e of r)e();o&&t.cancelVideoFrameCallback(i),t.pause()}}syncVideo(){let{video:e,store:t}=this,n=t.playing.value,r=t.speed.value,i=Math.max(t.playhead.value+this.offset.value,0);if(e.readyState!==0){if(e.playbackRate=Math.min(Math.max(r,.0625),16),!n&&!e.paused&&e.pause(),!e.seeking){let t=n?i:i+NS;Math.abs(e.currentTime-Math.min(t,e.duration))>(n?MS*Math.max(r,1):.001)&&(e.currentTime=t)}n&&e.paused&&i<e.duration&&this.play()}}async play(){let{video:e,store:t}=this;try{await e.play()}catch(n){if(!(n instanceof DOMException)||n.name!==`NotAllowedError`)return;e.muted?this.mayPlay=!1:(t.muted.value=e.muted=!0,t.playing.peek()&&await this.play())}}};function FS(e,t,n){let r=Math.min(t/e.width,n/e.height);return{left:(t-r*e.width)/2,top:(n-r*e.height)/2,scale:r}}var IS=50,LS=.35;function RS(e,{left:t,top:n,scale:r},i,a,o){let{joints:s,bones:c,sample_fps:l,n_samples:u}=i.head,d=Math.round(a*l);if(d<0||d>=u)return;let f=new Float32Array(3*s.length);ui(i,d/l,f);let p=e=>[t+r*f[3*e],n+r*f[3*e+1]],m=(...e)=>Math.min(...e.map(e=>f[3*e+2]))<IS?LS:1,h=new Set(c.flat().filter(e=>!Number.isNaN(f[3*e])));e.lineCap=`round`;for(let[t,n]of[[6,`rgb(0 0 0 / 55%)`],[3.5,o]]){e.lineWidth=t,e.strokeStyle=e.fillStyle=n;for(let[t,n]of c)h.has(t)&&h.has(n)&&(e.globalAlpha=m(t,n),ya(e,[p(t),p(n)]));for(let n of h)e.globalAlpha=m(n),e.beginPath(),e.arc(...p(n),t*.75,0,2*Math.PI),e.fill()}e.globalAlpha=1}var zS=[`Loop`,`Rank`,[`Seam`,`How far the ends are from each other before blending`],[`Slide`,`How fast planted feet move in the loop`],[`Turn`,`In a round`],`Speed`,``];function BS({close:e}){let{session:t}=H(),{edited:n,api:r,notifications:i,store:a}=t,o=V(null),s=V(``),c=V(new Set),[l,u]=Aa(),d=V(null),f=V(null),p=n.value;I(()=>{p&&p.waitUntilSent().then(()=>r.loadLoops(p.id)).then(({loops:e})=>{o.value=e,c.value=new Set(e.filter(({rank:e})=>e===1).map(e=>e.number))}).catch(e=>s.value=hr(e))},[p,r,o,c,s]);let m=()=>i.attempt(`clips`,async()=>{let e=[...c.value].sort((e,t)=>e-t);Sr(await r.exportClips(p.id,{rows:e,loops:!0}))}),h=async e=>{d.value=e;try{let t=await Jv(await r.loadLoop(p.id,e));d.peek()===e&&(f.value=t)}catch(e){s.value=hr(e)}},g=a.table.value?.segments??[],_=d.value===null?void 0:g[d.value];return U(ka,{title:`Repetitions as loops`,close:e,children:[U(`p`,{class:`quiet`,children:`The best of each cluster come first: their ends are close to each other, and planted feet stay where they are. Less is better, but for speed.`}),f.value&&_&&U(HS,{loop:f.value,name:VS(_),color:a.getColor(_)??`#DDDDDD`}),s.value&&U(`p`,{role:`alert`,children:s.value}),!s.value&&!o.value&&U(`span`,{class:`busy`,role:`status`,"aria-label":`Measuring`}),o.value?.length===0&&U(`p`,{children:`There are no repetitions in this recording.`}),!!o.value?.length&&U(S,{children:[U(`p`,{children:U(G,{disabled:!c.value.size||l!==``,onClick:()=>void u(`clips`,m),children:[`Save `,c.value.size,` as loops`]})}),U(Va,{class:`formats loops number`,columns:zS,rows:(o.value??[]).flatMap(t=>{let n=g[t.number];if(!n)return[];let r=VS(n),i=[U(Da,{checked:c.value.has(t.number),onCheck:()=>c.value=Ma(c.value,t.number),children:[U(wa,{color:a.getColor(n)}),` `,r]}),t.rank,`${(100*t.pose_m).toFixed(1)} cm`,t.slide_m_s===null?`–`:`${t.slide_m_s.toFixed(2)} m/s`,`${Math.round(t.turn_deg)}°`,`${t.speed_m_s.toFixed(2)} m/s`,U(S,{children:[U(G,{"aria-label":`Play ${r}`,"aria-pressed":d.value===t.number,title:`As it will be written, round after round`,onClick:()=>void h(t.number),children:`Play`}),` `,U(G,{"aria-label":`Show ${r}`,title:`Where it is in the recording`,onClick:()=>{a.select(n),e()},children:`Show`})]})];return[{key:t.number,cells:i}]})})]})]})}function VS(e){return`${$t(e)} at ${pn(e.start_s,2)}`}function HS({loop:e,name:t,color:n}){let r=R(null),i=R(null),a=V(!0),o=V(0),s=V(0);return I(()=>{let e=r.current,t=i.current=new WS(e),{stage:n}=t,a=()=>void(o.value+=1);n.controls.addEventListener(`change`,a);let s=new ResizeObserver(()=>{n.resize(e.clientWidth,e.clientHeight),a()});return s.observe(e),()=>{s.disconnect(),t.dispose()}},[o]),I(()=>{let t=i.current;t.show(e),s.value=0,a.value=!0;let r=ra.add(e=>{a.peek()&&(s.value+=e)}),c=ia(()=>void[o.value,a.value,s.value,$i.value],e=>{t.draw(s.peek(),xn(n,$i.peek())),t.stage.draw(a.peek(),e)});return()=>{r(),c()}},[e,n,a,o,s]),U(`div`,{class:`loop-player`,"data-playing":a.value,children:[U(`canvas`,{ref:r,tabIndex:0,role:`img`,"aria-label":`${t}, round after round. Drag or press alt and an arrow key to look from another side.`,onKeyDown:e=>Db(e,i.current)}),U(US,{playhead:s,lasts:Yv(e)}),U(`p`,{children:[U(La,{icon:a.value?`pause`:`play`,label:a.value?`Pause`:`Play`,onClick:()=>a.value=!a.value}),t,U(`span`,{class:`quiet number`,children:[Yv(e).toFixed(2),` s a round`]})]})]})}function US({playhead:e,lasts:t}){return U(`span`,{class:`round-done`,style:{width:`${100*(e.value/t%1)}%`}})}var WS=class{stage;loop=null;figure=null;pose=new Float32Array;constructor(e){this.stage=new Sy(e)}show(e){this.clear();let{head:t}=e.motion,n=qv(e.motion);this.loop=e,this.figure=new Ky(this.stage.fog,t,n),this.pose=new Float32Array(3*t.joints.length),this.stage.scene.add(this.figure.group),this.stage.fit(n.size,n.ground),Xv(e,0,this.pose);let[r,i]=this.getRootPosition(),a=new X(r,n.ground+.5*n.size,i),o=pi(e.motion,0)+.9;this.stage.lookAt(a,o,1.25*n.size,1.3*n.size)}draw(e,t){this.stage.setColors(),this.figure.setColors({body:W(`body`),joint:t,shadow:W(`shadow`)}),Xv(this.loop,e,this.pose),this.figure.setPose(this.pose),this.stage.moveTo(...this.getRootPosition())}dispose(){this.clear(),this.stage.dispose()}getRootPosition(){let e=3*mi(this.loop.motion.head);return[this.pose[e]||0,this.pose[e+2]||0]}clear(){this.figure?.group.removeFromParent(),this.figure?.dispose()}},GS=new Set([`compare`,`export`,`transfer`]);function KS(){let e=Pn(),{session:t,view:n}=H(),{value:r}=n.dialog,i=()=>{n.dialog.value===r&&(n.dialog.value=null)},a=r&&JS[r];Et(()=>{GS.has(n.dialog.value??``)&&We(()=>void t.refresh())});let o=!!e.recording.value?.motion,s=[{id:`segment`,title:`Segment`,panel:()=>U(Qx,{})},{id:`table`,title:`Table`,panel:()=>U(hS,{},e.recording.value?.id)},{id:`review`,title:`Review`,panel:()=>U(sx,{})},{id:`clusters`,title:`Clusters`,panel:()=>U(Bs,{})},{id:`compare`,title:`Compare`,panel:()=>U(Kb,{})},{id:`about`,title:Ga(e),panel:()=>U(Wa,{})}];return U(S,{children:[U(rC,{}),U(pc,{header:U(tC,{}),left:U(S,{children:[U(Lb,{}),U(zx,{}),U(Yx,{})]}),viewer:U(qS,{}),matrix:e.active.value&&U(Uc,{},e.recording.value?.id),side:U(yc,{label:`About the recording`,tabs:s,open:n.tab}),transport:U(S,{children:[U(el,{curves:o}),U(XS,{})]}),timeline:e.active.value&&U(Ho,{}),curves:o&&e.curves.value&&U(ts,{})}),U(yx,{}),U(Zc,{}),U(Gb,{}),a&&U(a,{close:i})]})}function qS(){let e=Pn(),{session:t}=H(),n=$S();return U(S,{children:[e.recording.value?.motion===null?U(ts,{ruler:!0}):n.value&&U(yb,{}),U(OS,{children:e=>U(ZS,{start:e})}),U(fx,{}),U(ix,{}),!e.active.value&&!t.videoWithoutPoses.value&&U(`p`,{class:`empty quiet`,children:t.opening.value||!t.state.value?U(`span`,{class:`busy`,role:`status`,"aria-label":`Opening`}):t.question.value||`Choose a recording on the left, or drop files here.`}),U(Wb,{})]})}var JS={versions:Fb,transfer:ES,compare:Mb,export:rx,loops:BS,help:sC},YS=[[`activity`,`Activities`],[`primitive`,`Primitives`]];function XS(){let e=Pn(),{editor:t}=H(),n={lane:e.getLane(e.workLevel.value),frame:e.frame.value},r=[[`Split`,`A border at the playhead (S)`,t.segment.value,()=>t.split()],[`Merge`,`The segment and the next one become one (M)`,Ln(n),()=>t.mergeWithNext()],[`Delete border`,`Delete the border nearest to the playhead (Delete)`,Rn(n),()=>t.deleteBorder()]];return U(S,{children:[U(`span`,{class:`group`,role:`group`,"aria-label":`Work on`,children:YS.map(([t,n])=>U(G,{"aria-pressed":e.workLevel.value===t,disabled:!e.getLane(t).length,title:`Work on ${n.toLowerCase()} (A)`,onClick:()=>e.setLevel(t),children:n},t))}),U(`span`,{class:`group edit-tools`,role:`group`,"aria-label":`Segments`,children:r.map(([e,t,n,r])=>U(G,{disabled:!n,title:t,onClick:r,children:e},e))})]})}function ZS({start:e}){let{session:t}=H(),{value:n}=t.store.recording;return!n||n.video?.picture?null:U(`label`,{title:`Seconds of the video at the start of the recording`,children:[`starts at `,U(Fa,{step:.02,value:+e.value.toFixed(3),onNumber:r=>{e.value=r,t.notifications.attempt(`video`,()=>t.api.placeVideo(n.id,{offset_s:r}))}}),` s of the video`]})}var QS=300;function $S(){let{session:e,review:t}=H(),n=V(nr().length>0);return Et(()=>{n.value||(e.opening.value!==null||e.store.opened.value.length>0?n.value=!0:t.folder.isReady.value&&setTimeout(()=>n.value=!0,QS))}),n}var eC=[[`versions`,`History…`,`Tables that were replaced: look at them, bring them back (H)`],[`transfer`,`Labels…`,`Labels from a knowledge base (T)`],[`compare`,`Compare…`,`Compare with another result (C)`],[`export`,`Export…`,`Write the segments as a file (E)`]];function tC(){let{session:e,view:t}=H(),n=e.edited.value,r=n?.confirmed.value,i=e.notifications.news.value;return U(S,{children:[U(`h1`,{children:`kineme`}),e.state.value?.of_library&&U(`a`,{href:$n(e.api.token),children:`Library`}),U(`span`,{class:`folder quiet`,title:e.state.value?.folder,children:r?.name??e.state.value?.folder}),U(`div`,{class:`spacer news-place`,role:`status`,children:i&&U(`span`,{class:i.refused?`news refused`:`news`,children:i.text})}),U(`span`,{class:`group`,children:[U(G,{disabled:!r?.can_undo&&!e.unsent.value.length,title:`Undo (Ctrl+Z)`,onClick:()=>n?.undo(),children:`↶ Undo`}),U(G,{disabled:!r?.can_redo,title:`Redo (Ctrl+Shift+Z)`,onClick:()=>void n?.edit({kind:`redo`}),children:`↷ Redo`})]}),U(nC,{}),U(`span`,{class:`group`,children:eC.map(([e,n,i])=>U(G,{title:i,disabled:!r,onClick:()=>t.show(e),children:n},e))}),U(Ra,{}),U(G,{class:`icon`,title:`Keys and help (?)`,"aria-label":`Keys and help`,onClick:()=>t.show(`help`),children:`?`})]})}function nC(){let{session:e}=H(),{saved:t,finding:n}=e.edited.value?.confirmed.value??{},r=e.unsent.value.length,i=n?`finding the segments…`:r?`saving ${Dt(r,`edit`)}…`:t?`saved as ${t}`:`not corrected yet`;return U(`span`,{class:`save-state quiet`,role:`status`,"data-unsent":r,title:i,children:[n&&U(`span`,{class:`busy`}),` `,e.edited.value?i:``]})}function rC(){let{session:e}=H(),{notifications:t,trouble:n,unsent:r}=e;return U(`div`,{class:`notices`,children:[U(`div`,{role:`alert`,children:[n.value&&U(`div`,{class:`notice danger`,"data-notice":`trouble`,children:U(`p`,{children:[n.value,` `,r.value.length>0&&U(aC,{edits:r.value})]})}),!n.value&&e.blocked.value.map(e=>U(iC,{edited:e},e.id)),t.problems.value.map(({text:e})=>U(`div`,{class:`notice danger`,"data-notice":`problem`,children:[U(`p`,{children:e}),U(Ca,{label:`Dismiss`,title:`Dismiss (Escape)`,onClick:()=>t.dismiss(e)})]},e))]}),U(oC,{})]})}function iC({edited:e}){return U(`div`,{class:`notice`,"data-notice":`held`,children:[U(`p`,{children:[e.confirmed.value.name,`: `,e.blocked.value,`. It is shown as it is now.`,` `,U(aC,{edits:e.describeUnsent()})]}),U(G,{class:`primary`,onClick:()=>e.retry(),children:`Make them here`}),U(G,{onClick:()=>e.discardEdits(),children:`Drop them`})]})}function aC({edits:e}){let t=e.slice(-3),n=e.length-t.length;return U(`span`,{class:`waiting`,children:[`Not saved yet: `,n>0&&`${n} earlier, `,t.join(`; `),`.`]})}function oC(){let{review:e}=H(),{offer:t}=e,{value:n}=t.present;if(!n)return U(`div`,{role:`status`});let{cluster:r,before:i,label:a}=n;return U(`div`,{class:`notice`,role:`status`,children:[U(`p`,{children:[`Cluster `,r,` is “`,a,`” here.`,` `,t.isLibrary()?`The library knows it in other recordings, too.`:`In other recordings it is known by its name, “${i}”.`]}),U(G,{class:`primary`,onClick:()=>void t.accept(),children:[`“`,a,`” in all recordings`]}),U(Ca,{label:`Here only`,onClick:()=>t.present.value=null})]})}function sC({close:e}){return U(ka,{title:`Keys`,close:e,children:[U(Qa,{keys:[...$s,...ri]}),U(`p`,{class:`quiet`,children:`Drag a border in the timeline to move it. Every edit is saved at once beside the recording, and can be undone.`})]})}function cC(){let e=new kn,t=new Gi(new lr(er()),e),n=ei(t),{editor:r,review:i,view:a}=n;ct(()=>{r.naming.value&&(a.tab.value=`segment`)}),ct(()=>{t.comparisons.comparison.value&&(a.tab.value=`compare`)}),ct(()=>{document.title=`${e.recording.value?.name??`kineme`} · kineme studio`}),ct(()=>{t.notifications.problems.value.length&&(a.dialog.value=null)}),lC(e),nc(e,e=>ii(e,n),()=>{let{segments:n}=e.table.value??{segments:[]};return{recordings:e.opened.value.map(e=>e.recording.value.name),segments:n,checked:n.flatMap((e,t)=>e.checked?[t]:[]),selected:e.selected.value??null,unsent:t.unsent.value}});for(let e of[`keyup`,`blur`])addEventListener(e,()=>r.release());ue(U(Nn,{value:e,children:U(ni,{value:n,children:U(KS,{})})}),document.getElementById(`page`)),nr().length||i.folder.refresh(),t.start(Ai())}function lC(e){let t=B(()=>`kineme.level|${location.pathname}|${e.recording.value?.id??``}`);ct(()=>{let n=localStorage.getItem(t.value)===`activity`?`activity`:`primitive`;We(()=>e.level.value=n)}),ct(()=>{let n=e.level.value;n===`activity`?localStorage.setItem(t.peek(),n):localStorage.removeItem(t.peek())})}cC();